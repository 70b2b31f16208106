// SPDX-License-Identifier: BSD-3-Clause
#include "core/exact_sum.hpp"

#include <cmath>

namespace carrom {

ExactSum::ExactSum(double bound) {
    int bound_exponent = 0;
    std::frexp(bound, &bound_exponent); // |bound| < 2^bound_exponent
    exponent_ = 125 - bound_exponent;
    scale_ = std::ldexp(1.0, exponent_);
}

void ExactSum::add_large(double term) { sum_ += static_cast<Wide>(std::ldexp(term, exponent_)); }

ExactSum& ExactSum::operator+=(const ExactSum& other) {
    sum_ += other.sum_;
    return *this;
}

ExactSum& ExactSum::operator-=(const ExactSum& other) {
    sum_ -= other.sum_;
    return *this;
}

double ExactSum::value() const { return std::ldexp(static_cast<double>(sum_), -exponent_); }

void ExactSum::add_words(std::uint64_t low, std::uint64_t high) {
    __extension__ using Unsigned = unsigned __int128;
    sum_ = static_cast<Wide>(static_cast<Unsigned>(sum_) +
                             ((static_cast<Unsigned>(high) << 64) | low));
}

} // namespace carrom

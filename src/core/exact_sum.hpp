// SPDX-License-Identifier: BSD-3-Clause
// A sum of doubles that does not depend on the order of its terms: 128-bit fixed point.
//
// The unit is chosen from a bound on the total, so that the sum cannot overflow and each term loses
// at most 2^-125 of that bound. Integer addition is associative: any split over threads and ranks
// gives the same bits.
#pragma once

#include <cmath>
#include <cstdint>

namespace carrom {

class ExactSum {
public:
    /// `bound` is at least the sum of the terms' magnitudes. It must be the same
    /// number in all parts that are added together.
    explicit ExactSum(double bound);

    void add(double term) {
        const double scaled = term * scale_; // exact, because the scale is a power of two
        if (std::fabs(scaled) < 0x1p62) [[likely]]
            sum_ += static_cast<std::int64_t>(scaled);
        else
            add_large(term);
    }
    /// Both sums must have the same bound.
    ExactSum& operator+=(const ExactSum& other);
    ExactSum& operator-=(const ExactSum& other);
    /// Adds integers in the sum's unit.
    void add_units(std::int64_t units) { sum_ += units; }
    /// The number of units in 1: the inverse of the unit, or infinite.
    double scale() const { return scale_; }
    void clear() { sum_ = 0; }
    double value() const;

    /// The two words of the raw sum, which ranks add with carries (see `add_words`).
    std::uint64_t low_word() const { return static_cast<std::uint64_t>(sum_); }
    std::uint64_t high_word() const { return static_cast<std::uint64_t>(sum_ >> 64); }
    void add_words(std::uint64_t low, std::uint64_t high);

private:
    __extension__ typedef __int128 Wide; // NOLINT: nvcc takes the extension of no other form

    void add_large(double term);

    Wide sum_ = 0;
    int exponent_ = 0; ///< the unit is 2^-exponent_
    double scale_ = 1; ///< 2^exponent_, or infinite
};

/// An empty sum with the same bound.
inline ExactSum emptied(ExactSum sum) {
    sum.clear();
    return sum;
}

#ifdef _OPENMP
// Threads sum parts, as they do with numbers.
#pragma omp declare reduction(+ : ExactSum : omp_out += omp_in)                                    \
    initializer(omp_priv = emptied(omp_orig))
#endif

} // namespace carrom

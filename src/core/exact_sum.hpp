// SPDX-License-Identifier: BSD-3-Clause
// Sums doubles in 128-bit fixed point, so that the order of the terms does not matter.
//
// The unit follows from a bound on the total, so that the sum cannot overflow and each term is
// wrong by at most 2^-124 of the bound. Addition of integers is associative, so any division among
// threads and ranks gives the same bits.
#pragma once

#include <cmath>
#include <cstdint>

namespace carrom {

class ExactSum {
public:
    /// `bound` must be at least the sum of the terms' absolute values. Sums that are added together
    /// must have the same bound.
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
    /// Adds `units` times the sum's unit.
    void add_units(std::int64_t units) { sum_ += units; }
    /// The inverse of the unit; infinite for bounds below about 2e-271.
    double scale() const { return scale_; }
    void clear() { sum_ = 0; }
    double value() const;

    /// The sum as two 64-bit words, from which Communicator::sum computes the sum over all ranks.
    std::uint64_t low_word() const { return static_cast<std::uint64_t>(sum_); }
    std::uint64_t high_word() const { return static_cast<std::uint64_t>(sum_ >> 64); }
    void add_words(std::uint64_t low, std::uint64_t high);

private:
    __extension__ typedef __int128 Wide; // NOLINT: nvcc accepts the extension in this form only

    void add_large(double term);

    Wide sum_ = 0;
    int exponent_ = 0; ///< the unit is 2^-exponent_
    double scale_ = 1; ///< 2^exponent_, or infinite if a double cannot hold it
};

/// Returns a sum of 0 with the same bound.
inline ExactSum emptied(ExactSum sum) {
    sum.clear();
    return sum;
}

#ifdef _OPENMP
// Lets OpenMP reduce these sums over threads, as it does with numbers.
#pragma omp declare reduction(+ : ExactSum : omp_out += omp_in)                                    \
    initializer(omp_priv = emptied(omp_orig))
#endif

} // namespace carrom

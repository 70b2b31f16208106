// SPDX-License-Identifier: BSD-3-Clause
// Sines of angles, and roots of functions in brackets. They are computed by + - * / in a fixed
// order, because the C library does not ensure the same bits on every machine.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace carrom {

inline constexpr double two_pi = 2 * std::numbers::pi;

/// Coefficients of the Taylor series: +-1 / n! for n = 3, 5, ... 17 (sine) and n = 4, 6, ... 16
/// (cosine). The next terms are below 2^-58 for angles up to pi / 4.
inline constexpr std::array<double, 8> sine_terms = {
    -1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
    -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
inline constexpr std::array<double, 7> cosine_terms = {
    1.0 / 24,        -1.0 / 720,         1.0 / 40320,         -1.0 / 3628800,
    1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000};

template <std::size_t n> double series(const std::array<double, n>& terms, double square) {
    double sum = terms[n - 1];
    for (std::size_t k = n - 1; k-- > 0;) sum = terms[k] + square * sum;
    return sum;
}

struct SineAndCosine {
    double sine = 0, cosine = 1;
};
/// Sine and cosine of 2 pi `turns`, for `turns` below 2^50, with errors up to about 2^-52.
SineAndCosine sine_of_turns(double turns);

/// The fractional part of a number of turns, from 0 to 1.
inline double whole_turns_off(double turns) { return turns - std::floor(turns); }

struct ValueAndSlope {
    double value, slope;
};

/// The root, between `low` and `high`, of a function with different signs at these ends, to within
/// the rounding error of `origin` plus the root. Uses Newton's method, or bisection if Newton's
/// step leaves the bracket or is more than half of the last step.
template <class Function>
double root_in_bracket(double low, double high, bool rises, double origin,
                       const Function& function) {
    double s = low + (high - low) / 2, last_step = high - low;
    for (;;) {
        const auto [value, slope] = function(s);
        if (value == 0) return s;
        ((value < 0) == rises ? low : high) = s;
        double next = s - value / slope;
        if (!(next > low && next < high && std::fabs(next - s) <= last_step / 2))
            next = low + (high - low) / 2;
        last_step = std::fabs(next - s);
        if (!(last_step > 0x1p-52 * (origin + next))) return next;
        s = next;
    }
}

} // namespace carrom

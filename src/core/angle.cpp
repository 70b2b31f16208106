// SPDX-License-Identifier: BSD-3-Clause
#include "core/angle.hpp"

#include <cmath>
#include <numbers>

namespace carrom {

namespace {

constexpr double turn = 2 * std::numbers::pi;

} // namespace

double wrapped_angle(double angle) {
    if (std::fabs(angle) <= std::numbers::pi) return angle;
    const double rest = angle - turn * std::floor(angle / turn + 0.5);
    return rest > std::numbers::pi    ? std::numbers::pi
           : rest < -std::numbers::pi ? -std::numbers::pi
                                      : rest; // clamped, because the sum may round to beyond pi
}

/// Computes the sine and 1 - cosine of a quarter of the angle by Taylor series, whose neglected
/// terms are below 2^-60. Formulas for the double angle are then applied twice.
Direction direction_of(double angle) {
    const double x = angle / 4, square = x * x;
    double of_sine = 1, of_versine = 1; // sin(x) / x, and 2 (1 - cos(x)) / x^2
    for (int n = 16; n >= 2; n -= 2) {
        of_sine = 1 - of_sine * square / (n * (n + 1));
        of_versine = 1 - of_versine * square / ((n + 1) * (n + 2));
    }
    double sine = x * of_sine, versine = square * of_versine / 2;
    for (int k = 0; k < 2; ++k) { // 1 - cos(2 x) = 2 sin^2(x) has no cancellation
        const double cosine = 1 - versine;
        versine = 2 * sine * sine;
        sine = 2 * sine * cosine;
    }
    return {1 - versine, sine};
}

double random_angle(DiscRandom random) { return turn * random.uniform() - std::numbers::pi; }

} // namespace carrom

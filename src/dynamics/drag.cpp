// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/drag.hpp"

#include <cmath>
#include <limits>

namespace carrom {

namespace {

/// (1 - exp(-z)) / z by 17 terms of its series, for 0 <= z <= 1/2; the last one is below 2^-60.
double short_integral(double z) {
    double sum = 1;
    for (int k = 17; k >= 2; --k) sum = 1 - z / k * sum;
    return sum;
}

/// Enough halvings to bring the product of the two largest doubles below 1/2
constexpr int most_halvings = 2100;

/// Halves a time until the series converges, and computes `clock` and `slowing` at the halved time.
/// If the time or the rate is infinite, the results are NaN.
struct Halving {
    Halving(double rate, double time) {
        for (; rate * time > 0.5 && count < most_halvings; time /= 2) ++count;
        const double z = rate * time, integral = z <= 0.5
                                                     ? short_integral(z)
                                                     : std::numeric_limits<double>::quiet_NaN();
        slowing = 1 - z * integral;
        clock = time * integral;
    }

    int count = 0;
    double slowing = 1, clock = 0;
};

} // namespace

double drag_slowing(double rate, double time) {
    const Halving halving(rate, time);
    double slowing = halving.slowing;
    for (int k = 0; k < halving.count; ++k) slowing *= slowing;
    return slowing;
}

double drag_clock(double rate, double time) {
    const Halving halving(rate, time);
    double slowing = halving.slowing, clock = halving.clock;
    for (int k = 0; k < halving.count; ++k, slowing *= slowing)
        clock *= 1 + slowing; // s(t) = s(t/2) (1 + exp(-c t/2)) subtracts no nearly equal numbers
    return clock;
}

double time_of_drag_clock(double rate, double clock) {
    return rate == 0 ? clock : -std::log1p(-rate * clock) / rate;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/drag.hpp"

#include <cmath>

namespace carrom {

namespace {

/// (1 - exp(-z)) / z by its series, 0 <= z <= 1/2: the 16th term is below 2^-60.
double short_integral(double z) {
    double sum = 1;
    for (int k = 17; k >= 2; --k) sum = 1 - z / k * sum;
    return sum;
}

} // namespace

double drag_slowing(double rate, double time) {
    const double z = rate * time;
    if (z <= 0.5) return 1 - z * short_integral(z);
    const double half = drag_slowing(rate, time / 2);
    return half * half;
}

double drag_clock(double rate, double time) {
    const double z = rate * time;
    if (z <= 0.5) return time * short_integral(z);
    // s(t) = s(t/2) (1 + exp(-c t/2)) avoids subtracting like numbers.
    return drag_clock(rate, time / 2) * (1 + drag_slowing(rate, time / 2));
}

double time_of_drag_clock(double rate, double clock) {
    return rate == 0 ? clock : -std::log1p(-rate * clock) / rate;
}

} // namespace carrom

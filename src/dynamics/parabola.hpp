// SPDX-License-Identifier: BSD-3-Clause
// The distance between a point that moves on a parabola and a point at rest, and the search for a
// root in a bracket. falling_contact.cpp and arc_contact.cpp use this code.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "dynamics/never.hpp"

namespace carrom {

/// Maximum number of steps of the root search. Newton's method takes about ten steps. Bisection
/// alone takes fewer than 100 for most intervals.
inline constexpr int most_newton_steps = 100;

struct ValueAndRate {
    double value, slope;
};

/// The root, between `low` and `high`, of a function with different signs at these ends. `rises` is
/// true if it is negative at `low`. `function(s)` returns the value and the slope.
template <class Function>
double root_between(double low, double high, bool rises, const Function& function) {
    double s = low + (high - low) / 2;
    for (int k = 0; k < most_newton_steps; ++k) {
        const auto [value, slope] = function(s);
        ((value < 0) == rises ? low : high) = s;
        double next = s - value / slope;
        if (!(next > low && next < high)) next = low + (high - low) / 2;
        if (next == s || !(next > low && next < high)) break;
        s = next;
    }
    return s;
}

struct Parabola {
    double dx, dy, wx, wy, gx, gy, reach;

    ValueAndRate gap(double s) const {
        const auto [x, y, vx, vy] = at(s);
        const double distance = std::sqrt(x * x + y * y);
        return {distance - reach, (x * vx + y * vy) / distance};
    }
    /// Half the derivative of the squared distance.
    ValueAndRate rate(double s) const {
        const auto [x, y, vx, vy] = at(s);
        return {x * vx + y * vy, (vx * vx + vy * vy) + (x * gx + y * gy)};
    }
    /// Times at which `rate` has its extrema, ascending; both infinite if there is none.
    std::array<double, 2> bends() const {
        const double a = 1.5 * (gx * gx + gy * gy), b = 3 * (wx * gx + wy * gy),
                     c = (wx * wx + wy * wy) + (dx * gx + dy * gy);
        const double square = b * b - 4 * a * c;
        if (!(square > 0)) return {never, never};
        const double sum = -(b + std::copysign(std::sqrt(square), b)) / 2;
        std::array<double, 2> found{sum / a, c / sum};
        if (found[1] < found[0]) std::swap(found[0], found[1]);
        return found;
    }
    /// A time after `s` from which on the distance only increases.
    double late(double s) const {
        const double g = std::sqrt(gx * gx + gy * gy);
        double step = std::sqrt(wx * wx + wy * wy) / g +
                      std::sqrt(std::sqrt(dx * dx + dy * dy) / g);
        while (rate(s + step).value < 0) step *= 2;
        return s + step;
    }

private:
    std::array<double, 4> at(double s) const {
        return {(dx + wx * s) + (0.5 * gx * s) * s, (dy + wy * s) + (0.5 * gy * s) * s, wx + gx * s,
                wy + gy * s};
    }
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// When a disc that falls meets a wall: a quadratic, and with drag a transcendental function that is
// as tame.
//
// With drag of the rate c and in its clock s (drag.hpp) a disc under the acceleration g is at x + v
// s + g F(s), F = (-log(1 - c s) - c s) / c^2, which is s^2 / 2 and more. So all discs share the
// fall, and the time of the parabola bounds a contact from the side from which Newton's rule comes
// to it step by step, never beyond: no bracket, a handful of steps. + - * / and sqrt in a fixed
// order, the same bits on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace carrom {

/// The first time at which distance + velocity t + pull t^2 / 2 is not positive and falls; infinite
/// if there is none. Touching counts while it falls, not while it grows. No like numbers are
/// subtracted.
inline double fall_delay(double distance, double velocity, double pull) {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (velocity < 0) {
        if (!(distance > 0)) return 0;
        if (pull == 0) return distance / -velocity;
        const double square = velocity * velocity - 2 * pull * distance;
        return square > 0 ? 2 * distance / (-velocity + std::sqrt(square))
                          : never; // pulled away before it gets there
    }
    if (!(pull < 0)) return never;
    // It comes back. A disc that rounding has left beyond the wall comes up to it first, or else
    // turns round where it is.
    return (velocity + std::sqrt(std::max(velocity * velocity - 2 * pull * distance, 0.0))) / -pull;
}

/// F(s) of the drag `rate` c, to some ulp; 0 <= c s < 1.
double dragged_fall(double rate, double clock);
/// Its derivative, s / (1 - c s).
inline double dragged_fall_speed(double rate, double clock) { return clock / (1 - rate * clock); }

/// As fall_delay, of distance + velocity s + pull F(s): what drag's clock shows then, set to 0 now.
/// Contacts at which less than a hundredth of a velocity is left are none: a sync comes before.
double dragged_fall_delay(double distance, double velocity, double pull, double rate);

} // namespace carrom

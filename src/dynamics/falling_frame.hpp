// SPDX-License-Identifier: BSD-3-Clause
// A uniform acceleration, alone or with linear drag (drag.hpp).
//
// All discs have the same acceleration, so states are stored in a frame that falls with them. At
// each sync the frame starts anew, at rest in the box. Discs fly straight in this frame, so
// collisions of pairs do not depend on the fall. In the frame walls rise, and the time at which a
// disc meets a wall is a root of a quadratic.
//
// With drag of the rate c the frame has its own clock s. A disc under the acceleration g is at x +
// v s + g F(s), with F = (-log(1 - c s) - c s) / c^2 >= s^2 / 2. The term g F(s) is the same for
// all discs. The contact time for F = s^2 / 2 is a bound, from which Newton's method approaches the
// contact from one side in a few steps, without a bracket. The code uses only + - * / and sqrt in a
// fixed order, so the bits are the same on every machine.
//
// sway.hpp describes the frame for an acceleration that changes in time, which excludes drag.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "core/flight_integral.hpp"
#include "core/frame.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/never.hpp"
#include "dynamics/sway.hpp"

namespace carrom {

/// The first time at which distance + velocity t + pull t^2 / 2 is not positive and decreases;
/// infinite if there is none. A disc that touches the wall meets it only while this distance
/// decreases. No nearly equal numbers are subtracted.
inline double fall_delay(double distance, double velocity, double pull) {
    if (velocity < 0) {
        if (!(distance > 0)) return 0;
        if (pull == 0) return distance / -velocity;
        const double square = velocity * velocity - 2 * pull * distance;
        return square > 0 ? 2 * distance / (-velocity + std::sqrt(square))
                          : never; // the pull turns the disc back before it reaches the wall
    }
    if (!(pull < 0)) return never;
    // The disc comes back. If rounding has put it beyond the wall, the contact is at the later
    // root, or at the turning point if there is no root.
    return (velocity + std::sqrt(std::max(velocity * velocity - 2 * pull * distance, 0.0))) / -pull;
}

/// F(s) for drag of the rate c, accurate to a few ulps; 0 <= c s < 1.
double dragged_fall(double rate, double clock);
/// The derivative of F, s / (1 - c s).
inline double dragged_fall_speed(double rate, double clock) { return clock / (1 - rate * clock); }

/// Like fall_delay, for distance + velocity s + pull F(s), where drag's clock s is 0 at present.
/// Contacts after drag has reduced velocities to a hundredth are ignored: the next sync is earlier.
double dragged_fall_delay(double distance, double velocity, double pull, double rate);

/// The frame that falls with the discs, and its clock, which shows the time since the last sync.
class FallingFrame {
public:
    /// `effects` have times in micro-steps.
    explicit FallingFrame(const Effects& effects)
        : acceleration_(effects.acceleration()), drag_(effects.drag), sway_(acceleration_) {}

    /// Starts a sync interval: from now on times are relative to micro-step `n` of the scene.
    void begin_interval(double n) { sway_.begin_interval(n); }

    double clock_at(double micro_steps) const;
    double micro_steps_at(double clock) const;

    const Acceleration& acceleration() const { return acceleration_; }
    bool slows() const { return drag_ != 0; }
    bool is_on() const { return acceleration_.is_on() || drag_ != 0; }

    /// How far a disc falls from rest in `time` under the acceleration `g`; `falling_time` is the
    /// speed that it gains divided by g.
    double fallen(double g, double time) const {
        if (drag_ == 0 || g == 0) return (0.5 * g * time) * time;
        return g * dragged_fall(drag_, time);
    }
    double falling_time(double time) const {
        return drag_ == 0 ? time : dragged_fall_speed(drag_, time);
    }
    /// exp(-c t) = 1 - c s: the factor from velocities on the clock to velocities in the box.
    double slowing_at(double time) const { return 1 - drag_ * time; }

    /// The integral of v_a v_b over flights since the last sync (core/flight_integral.hpp). It does
    /// not use the C library, so its bits are the same on every machine.
    FlightIntegral flight_integral_at(double time) const;
    /// The weight of flight_integral_at divided by slowing_at, as a factor for impulses in the box.
    double pair_weight_at(double time) const {
        return drag_ == 0 ? time : time * (1 - 0.5 * drag_ * time) / slowing_at(time);
    }

    /// The frame's origin and velocity in the box.
    Frame at(double time) const {
        if (is_on()) return moving_at(time);
        Frame at_rest; // returned without computation, because it is needed often
        at_rest.clock = time;
        return at_rest;
    }
    /// Converts a state advanced to `time` to a frame that is at rest in the box at that time.
    void restart(DiscState& disc, double time) const { disc = at(time).in_box(disc, time); }
    /// An upper bound of the distance by which the frame jumps along `axis` at a sync at `time`.
    double jump_at(Axis axis, double time) const {
        return std::fabs(
            fallen(along(axis, acceleration_.largest_x(), acceleration_.largest_y()), time));
    }
    /// An upper bound of the speed of the frame at `time`, on its own clock.
    double speed_gained_at(double time) const {
        return (acceleration_.largest_x() + acceleration_.largest_y()) * falling_time(time);
    }
    /// The part of the acceleration that changes in time.
    const Sway& sway() const { return sway_; }

private:
    Frame moving_at(double time) const;
    FlightIntegral swaying_flight_integral_at(double time) const;

    Acceleration acceleration_;
    double drag_;
    Sway sway_;
};

} // namespace carrom

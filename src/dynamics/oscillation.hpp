// SPDX-License-Identifier: BSD-3-Clause
// A wall that oscillates about its line: its distance from the line is A sin(2 pi t / P +
// phase), along +x or +y, with t the time since the scene's start. The wall has infinite
// mass, so nothing changes its motion.
//
// In the falling frame the distance between the wall and a disc is a parabola minus a sine. The
// derivative of this distance is monotone between the times at which wall and disc have the same
// acceleration. These times are known, and there are at most two in a period. So one bracket finds
// each extremum, and another bracket finds the first root: no contact is missed, at any speed of
// the wall. A disc that stays closer to the line than the amplitude for a whole period meets the
// wall. So each time a disc comes that close, little more than one period is searched.
//
// The code uses only + - * / and sqrt in a fixed order, so bits are the same on every machine.
#pragma once

#include "dynamics/effects.hpp"

namespace carrom {

/// Position, velocity and acceleration along +x or +y, relative to the wall's line.
struct WallMotion {
    double place = 0, velocity = 0, acceleration = 0;
};

/// The motion of the wall at a time since the scene's start, in the unit of the side's period.
WallMotion oscillation_at(const Boundary& side, double time);

/// The oscillation of one side in the falling frame.
class Oscillation {
public:
    /// A wall that does not oscillate.
    Oscillation() = default;
    /// `side` has times in micro-steps. `sign` is 1 if the inside of the box is in the positive
    /// direction from the wall, else -1. Discs have `acceleration` along the axis; `slack` is a
    /// bound on the rounding errors of positions.
    Oscillation(const Boundary& side, double sign, double acceleration, double slack);

    bool is_on() const { return amplitude_ > 0; }
    double amplitude() const { return amplitude_; }
    double largest_speed() const { return amplitude_ * rate_; }

    /// Starts a sync interval at `time` since the scene's start; other times are relative to it.
    void begin_interval(double time);
    WallMotion at(double time) const;
    /// The acceleration towards the wall, relative to it, of a disc that touches it: the larger of
    /// the values at `time` and at `later`. It is negative if the wall accelerates away from discs.
    double pressure_at(double time, double later) const;

    /// The delay from `time` until the disc first is at the wall or beyond it, and approaches it;
    /// `never` if this does not happen. `distance` is the disc's distance from the wall's line at
    /// `time`, positive inwards, and `rate` is its derivative. `from_wall` is the derivative of the
    /// distance from the wall itself; if it is positive, there is no contact at `time`. A contact
    /// in which the disc would get less than the slack beyond the wall may be missed.
    double contact_delay(double distance, double rate, double from_wall, double time) const;

private:
    struct Flight;

    double first_contact(const Flight& flight, double begin, double end) const;
    double bend_after(double time) const;

    double amplitude_ = 0, period_ = 1, rate_ = 0; ///< rate: angular frequency 2 pi / period
    double phase_ = 0, turns_ = 0;           ///< phase in turns, at the scene's start and last sync
    double sign_ = 1, pull_ = 0, slack_ = 0; ///< pull: acceleration of discs towards the inside
    /// Times, in turns from 0 to 1, at which wall and discs have equal acceleration (see the top)
    double first_bend_ = 0, second_bend_ = 0;
};

} // namespace carrom

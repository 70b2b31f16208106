// SPDX-License-Identifier: BSD-3-Clause
// A wall that oscillates about its line: its distance from there is A sin(2 pi t / P +
// phase), along +x or +y, with t the time since the scene's start. It is infinitely
// heavy, so nothing changes its motion.
//
// In the falling frame its distance to a disc is a parabola less a sine. The rate of this is
// monotone between the times at which wall and disc have the same acceleration, which are known
// beforehand, two to a period. So a bracket finds each extremum, and another one the first root:
// no contact is missed, however fast or slow the wall is. A disc that is within the wall's
// highest place for a whole period meets it, so the search covers a period, or two, or none.
//
// It uses only + - * / and sqrt in a fixed order, so the bits are the same on every machine.
#pragma once

#include "dynamics/effects.hpp"

namespace carrom {

/// Along +x or +y, relative to the wall's line.
struct WallMotion {
    double place = 0, velocity = 0, acceleration = 0;
};

/// The motion of the wall at a time since the scene's start, in the unit of the side's period.
WallMotion oscillation_at(const Boundary& side, double time);

/// The oscillation of one side in the falling frame.
class Oscillation {
public:
    /// No oscillation.
    Oscillation() = default;
    /// `side` is per micro-step, `sign` is 1 if the inside is in the positive
    /// direction, else -1. `gravity` is along the axis, `slack` the rounding of places.
    Oscillation(const Boundary& side, double sign, double gravity, double slack);

    bool is_any() const { return amplitude_ > 0; }
    double amplitude() const { return amplitude_; }
    double largest_speed() const { return amplitude_ * rate_; }

    /// From now on times count from `time` since the scene's start.
    void begin_interval(double time);
    WallMotion at(double time) const;
    /// The pull that presses a disc at the wall against it: the larger value now and
    /// at `later`. It is negative if the wall draws back faster than discs fall.
    double pressure_at(double time, double later) const;

    /// The time after `time` until the disc first is at the wall or beyond, and comes
    /// nearer. `distance` and its `rate` are from the line at `time`, towards the
    /// inside. `from_wall` is the rate relative to the wall itself; its sign decides
    /// at `time`. Contacts less deep than the slack may be missed.
    double contact_delay(double distance, double rate, double from_wall, double time) const;

private:
    struct Flight;

    double first_contact(const Flight& flight, double begin, double end) const;
    double bend_after(double time) const;

    double amplitude_ = 0, period_ = 1, rate_ = 0; ///< rate: 2 pi / period
    double phase_ = 0, turns_ = 0;                 ///< in turns, at the start and at the last sync
    double sign_ = 1, pull_ = 0, slack_ = 0;       ///< pull: gravity towards the inside
    double first_bend_ = 0, second_bend_ = 0;      ///< turns, within one: see the top
};

} // namespace carrom

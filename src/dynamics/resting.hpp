// SPDX-License-Identifier: BSD-3-Clause
// The state of a disc that rests: it lies still in the box, while the frame of states falls.
//
// Its place in the box, and how far the frame has fallen, are multiples of one grid that is some
// ulp(L) wide. So its state can be written for any time, and the place in the box comes back from
// it without rounding. Engines write the states of resting discs anew at the start of each window,
// because cells and strips take a disc's place from its state. That changes no bit of the run.
#pragma once

#include <cmath>

#include <carrom/box.hpp>

#include "core/disc.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

class RestingPlaces {
public:
    /// `gravity` per micro-step.
    RestingPlaces(const Box& box, const Gravity& gravity)
        : gravity_(gravity),
          // Adding it leaves a sum in [2^52, 2^53) units of the grid; places and falls are below
          // 2 L together.
          rounder_(std::ldexp(1.5, std::ilogb(box.longest()) + 3)) {}

    /// At a sync: the disc comes to rest where it is.
    void settle(Disc& disc) const {
        disc.x = on_grid(disc.x);
        disc.y = on_grid(disc.y);
        disc.vx = disc.vy = disc.tau = 0;
        disc.is_resting = 1;
    }
    /// At `time` the disc comes to rest at (x, y) in the box.
    void stop(Disc& disc, double x, double y, double time) const {
        disc.x = on_grid(x);
        disc.y = on_grid(y);
        disc.tau = 0;
        write_for(disc, time);
        disc.is_resting = 1;
    }
    /// Writes the state of a resting disc for `time`.
    void write_for(Disc& disc, double time) const {
        disc.x = x_of(disc) - on_grid(fallen(gravity_.x, time));
        disc.y = y_of(disc) - on_grid(fallen(gravity_.y, time));
        disc.vx = -(gravity_.x * time);
        disc.vy = -(gravity_.y * time);
        disc.tau = time;
    }
    /// The place of a resting disc in the box.
    double x_of(const Disc& disc) const { return disc.x + on_grid(fallen(gravity_.x, disc.tau)); }
    double y_of(const Disc& disc) const { return disc.y + on_grid(fallen(gravity_.y, disc.tau)); }

    /// From `time` on the disc moves like others.
    void wake(Disc& disc, double time) const {
        const double x = x_of(disc), y = y_of(disc);
        disc.x = x - fallen(gravity_.x, time);
        disc.y = y - fallen(gravity_.y, time);
        disc.vx = -(gravity_.x * time);
        disc.vy = -(gravity_.y * time);
        disc.tau = time;
        disc.is_resting = 0;
    }

    static double fallen(double g, double time) { return (0.5 * g * time) * time; }
    const Gravity& gravity() const { return gravity_; }

private:
    double on_grid(double place) const { return (place + rounder_) - rounder_; }

    Gravity gravity_;
    double rounder_;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The sides of a box without effects: four elastic walls at rest, for discs of one radius.
// MirrorSides has functions with the same names as Boundaries (boundaries.hpp), which is used for
// scenes with effects.
#pragma once

#include <cstdint>

#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "core/extent.hpp"
#include "dynamics/bodies.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/resting_walls.hpp"

namespace carrom {

template <class Arithmetic> class MirrorSides {
    using Real = typename Arithmetic::Real;
    using State = typename Arithmetic::State;

public:
    MirrorSides(const Box& box, double radius, const Effects& /*effects*/)
        : box_(box), x_walls_(static_cast<Real>(box.x), static_cast<Real>(radius), 0),
          y_walls_(static_cast<Real>(box.y), static_cast<Real>(radius), 0) {}

    static void begin_interval(std::int64_t /*n*/) {}
    static constexpr bool are_any_open() { return false; }
    static constexpr bool is_open_ahead(const DiscState& /*disc*/, Axis /*axis*/) { return false; }
    Extent extent_at(double /*time*/) const { return {0, box_.x, 0, box_.y}; }
    Extent walls_between(double /*begin*/, double /*end*/) const { return {0, box_.x, 0, box_.y}; }

    /// The time at which the disc meets the low or the high side of this axis, or `never`.
    double wall_time(const DiscState& disc, Axis axis, const Body& /*body*/) const {
        const State d(disc);
        return d.tau + walls(axis).delay(along(axis, d.x, d.y), along(axis, d.vx, d.vy));
    }
    CARROM_DEVICE bool may_meet(const DiscState& disc, double time, double margin,
                                const Body& /*body*/) const {
        const double x = disc.x_at(time), y = disc.y_at(time);
        return !(x > x_walls_.low() + margin && x < x_walls_.high() - margin &&
                 y > y_walls_.low() + margin && y < y_walls_.high() - margin);
    }
    Loss bounce(DiscState& disc, Axis axis, double time, const Body& /*body*/, const Body& /*then*/,
                double* spin) const {
        Arithmetic::advance(disc, time);
        reverse(disc, axis, {}, spin);
        disc.wall_collisions += 1;
        return {};
    }
    CARROM_DEVICE static void reverse(DiscState& disc, Axis axis, const Body& /*body*/,
                                      double* /*spin*/) {
        double& velocity = axis == Axis::x ? disc.vx : disc.vy;
        velocity = -velocity;
    }

private:
    const RestingWalls<Real>& walls(Axis axis) const {
        return axis == Axis::x ? x_walls_ : y_walls_;
    }

    Box box_;
    RestingWalls<Real> x_walls_, y_walls_;
};

} // namespace carrom

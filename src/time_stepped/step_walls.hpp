// SPDX-License-Identifier: BSD-3-Clause
// Collisions with walls, open sides and fixed bodies within a micro-step m of the time-stepped
// method (docs/understanding/method.md, section 3). Times t are within the micro-step, 0 to 1.
//
// A disc collides at most once in a micro-step. If it would then reach a wall or a fixed body in
// the same micro-step, it stops there, and bounces in the next micro-step. Walls are at rest in
// this method. How discs bounce off each side is defined in dynamics/boundaries.hpp.
#pragma once

#include <algorithm>

#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "dynamics/all_dynamics.hpp"

namespace carrom {

/// Whether a disc bounces off a wall across x, and off a wall across y.
struct MetWalls {
    bool at_x = false, at_y = false;
};

/// Holds a reference to the dynamics, which must outlive it.
template <class Dynamics> class StepWalls {
    using Real = typename Dynamics::Real;
    using State = typename Dynamics::Arithmetic::State;

public:
    CARROM_DEVICE explicit StepWalls(const Dynamics& dynamics) : dynamics_(dynamics) {}

    /// The time of the disc's first bounce in micro-step m, or `never`.
    CARROM_DEVICE double time(const DiscState& disc, double m) const {
        const double at_side = side_time(disc, m);
        if (!has_fixed_bodies()) return at_side;
        return std::min(at_side, fixed_body(disc, m).time - m);
    }

    /// Carries out the bounce at t = time(disc, m). A corner reverses both components of the
    /// velocity and counts as one collision. `spin` is null if discs do not rotate.
    CARROM_DEVICE void bounce(DiscState& disc, double m, double t, double* spin) const {
        if (has_fixed_bodies() && t != side_time(disc, m))
            return bounce_off_fixed_body(disc, m, t, spin);
        const double x_time = side_time(disc, Axis::x, m), y_time = side_time(disc, Axis::y, m);
        advance(disc, m, t);
        if (x_time == t && is_open(disc, Axis::x)) return depart(disc, Axis::x, m + t, spin);
        if (y_time == t && is_open(disc, Axis::y)) return depart(disc, Axis::y, m + t, spin);
        const bool x_reverses = x_time == t || is_at_wall(disc, Axis::x);
        const bool y_reverses = y_time == t || is_at_wall(disc, Axis::y);
        const bool goes_down = disc.vy < 0;
        if (x_reverses) reverse(disc, Axis::x, spin);
        // A thermal wall may have turned the disc away from the second wall.
        if (y_reverses && (goes_down ? disc.vy < 0 : disc.vy > 0)) reverse(disc, Axis::y, spin);
        disc.wall_collisions += 1;
        stop(disc, m, t);
    }

    /// The walls that the disc bounces off at t; empty if it bounces off a fixed body.
    CARROM_DEVICE MetWalls met(const DiscState& before, double m, double t) const {
        if (has_fixed_bodies() && t != side_time(before, m)) return {};
        DiscState disc = before;
        const double x_time = wall_time(disc, Axis::x, m), y_time = wall_time(disc, Axis::y, m);
        advance(disc, m, t);
        return {x_time == t || touches(disc, Axis::x), y_time == t || touches(disc, Axis::y)};
    }

    /// The fixed body that the disc bounces off at t, or no_body.
    std::uint32_t met_fixed_body(const DiscState& before, double m, double t) const {
        if (!dynamics_.has_fixed_bodies() || t == side_time(before, m)) return BodyContact::no_body;
        return fixed_body(before, m).body;
    }

    /// Stops a disc that has just collided at t, if it would meet a wall or a fixed body before the
    /// micro-step ends. `left` is the fixed body that it has just left.
    [[gnu::always_inline]] CARROM_DEVICE void stop(
        DiscState& disc, double m, double t, std::uint32_t left = BodyContact::no_body) const {
        const Real rest = 1 - static_cast<Real>(t);
        const Real at_side = std::min(side_stop(disc, Axis::x, rest),
                                      side_stop(disc, Axis::y, rest));
        if (has_fixed_bodies() && stops_at_fixed_body(disc, m, at_side, left)) return;
        if (at_side == RestingWalls<Real>::never) return;
        const State d(disc);
        const Real x = d.x + d.vx * at_side, y = d.y + d.vy * at_side;
        disc.x = x;
        disc.y = y;
        disc.tau = m + 1;
    }

private:
    CARROM_DEVICE bool has_fixed_bodies() const {
        return Dynamics::may_have_fixed_bodies && dynamics_.has_fixed_bodies();
    }
    CARROM_DEVICE static void advance(DiscState& disc, double m, double t) {
        Dynamics::advance(disc, static_cast<Real>(m) + static_cast<Real>(t));
    }

    [[gnu::always_inline]] CARROM_DEVICE double wall_time(const DiscState& disc, Axis axis,
                                                          double m) const {
        if (dynamics_.is_periodic_along(axis)) return never;
        const State d(disc);
        return dynamics_.resting_walls(axis, disc)
            .time(along(axis, d.x, d.y), along(axis, d.vx, d.vy), d.tau, static_cast<Real>(m));
    }
    CARROM_DEVICE bool touches(const DiscState& disc, Axis axis) const {
        if (dynamics_.is_periodic_along(axis)) return false;
        const State d(disc);
        return dynamics_.resting_walls(axis, disc)
            .touches(along(axis, d.x, d.y), along(axis, d.vx, d.vy));
    }
    CARROM_DEVICE bool is_at_wall(const DiscState& disc, Axis axis) const {
        return touches(disc, axis) && !is_open(disc, axis);
    }

    /// Whether the disc's motion along `axis` is towards an open side.
    CARROM_DEVICE bool is_open(const DiscState& disc, Axis axis) const {
        return Dynamics::may_lose_discs && along(axis, disc.vx, disc.vy) != 0 &&
               dynamics_.sides().is_open_ahead(disc, axis);
    }
    /// A disc leaves through an open side when its centre is a radius beyond the side.
    [[gnu::always_inline]] CARROM_DEVICE double side_time(const DiscState& disc, Axis axis,
                                                          double m) const {
        if constexpr (Dynamics::may_lose_discs) {
            if (is_open(disc, axis)) return departure_time(disc, axis, m);
        }
        return wall_time(disc, axis, m);
    }
    [[gnu::always_inline]] CARROM_DEVICE double side_time(const DiscState& disc, double m) const {
        return std::min(side_time(disc, Axis::x, m), side_time(disc, Axis::y, m));
    }
    CARROM_DEVICE double departure_time(const DiscState& disc, Axis axis, double m) const {
        const auto& sides = dynamics_.sides();
        const double x = along(axis, disc.x, disc.y), v = along(axis, disc.vx, disc.vy);
        const double line = sides.departure(sides.side_ahead(disc, axis), dynamics_.body_of(disc)),
                     at_end = x + v * ((m + 1) - disc.tau);
        if (v < 0 ? !(at_end < line) : !(at_end > line)) return never;
        return std::clamp((disc.tau - m) + (line - x) / v, 0.0, 1.0);
    }
    CARROM_DEVICE void depart(DiscState& disc, Axis axis, double time, double* spin) const {
        if constexpr (Dynamics::may_lose_discs)
            dynamics_.sides().depart(disc, Boundaries::side_ahead(disc, axis), time,
                                     dynamics_.body_of(disc), spin);
    }
    CARROM_DEVICE void reverse(DiscState& disc, Axis axis, double* spin) const {
        dynamics_.sides().reverse(disc, axis, dynamics_.body_of(disc), spin);
    }

    [[gnu::always_inline]] CARROM_DEVICE Real side_stop(const DiscState& disc, Axis axis,
                                                        Real rest) const {
        if (dynamics_.is_periodic_along(axis) || is_open(disc, axis))
            return RestingWalls<Real>::never;
        const State d(disc);
        return dynamics_.resting_walls(axis, disc)
            .stop(along(axis, d.x, d.y), along(axis, d.vx, d.vy), rest);
    }
    CARROM_DEVICE BodyContact fixed_body(const DiscState& disc, double m) const {
        if constexpr (Dynamics::may_have_fixed_bodies)
            return dynamics_.first_fixed_body(disc, {m, m + 1});
        else
            return {};
    }
    CARROM_DEVICE void bounce_off_fixed_body(DiscState& disc, double m, double t,
                                             double* spin) const {
        if constexpr (Dynamics::may_have_fixed_bodies) {
            const BodyContact contact = fixed_body(disc, m);
            dynamics_.bounce_off(disc, contact.body, contact.time, never, spin);
            stop(disc, m, t, contact.body);
        }
    }
    /// Stops the disc at the first fixed body in its path, and returns true. Does nothing and
    /// returns false if there is no such body in this micro-step, or if a side stops it earlier.
    CARROM_DEVICE bool stops_at_fixed_body(DiscState& disc, double m, double at_side,
                                           std::uint32_t left) const {
        if constexpr (Dynamics::may_have_fixed_bodies) {
            const BodyContact contact = dynamics_.first_fixed_body(disc,
                                                                   {disc.tau, m + 1, true, left});
            if (!(contact.time < m + 1 && contact.time - disc.tau < at_side)) return false;
            Dynamics::advance(disc, contact.time);
            disc.tau = m + 1;
        }
        return true;
    }

    const Dynamics& dynamics_;
};

} // namespace carrom

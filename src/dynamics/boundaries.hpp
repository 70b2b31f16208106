// SPDX-License-Identifier: BSD-3-Clause
// The four sides of a box with effects: lossy, thermal, moving and oscillating walls, and open
// sides. Periodic sides are treated as walls infinitely far away.
//
// Times and positions are in the falling frame (falling_frame.hpp). There, a wall that starts at w0
// and moves with the velocity u in the box is at w(t) = (w0 + u t) - (g/2 t) t and has the velocity
// u - g t, where g is the acceleration of discs. Its distance to a disc is quadratic in time, and
// the time of contact is computed without subtracting nearly equal numbers. For g = 0 and u = 0 the
// results equal those of plain dynamics, bit for bit. With drag of rate c and its clock s, where t
// = s + c F(s), the wall is at (w0 + u s) - (g - c u) F(s). An oscillating wall moves about such a
// line (oscillation.hpp).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "dynamics/bodies.hpp"
#include "dynamics/contact_guard.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/falling_frame.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/never.hpp"
#include "dynamics/oscillation.hpp"
#include "dynamics/surface_table.hpp"

namespace carrom {

class Boundaries {
public:
    /// `effects` have times in micro-steps; `radius` is the largest radius of a disc.
    Boundaries(const Box& box, double radius, const Effects& effects);

    /// Starts a sync interval: from now on times are relative to micro-step `n` of the scene.
    void begin_interval(std::int64_t n);
    /// Positions of the walls at `time`, in the frame's coordinates.
    Extent extent_at(double time) const;
    /// Bounds that lie inside the walls throughout [begin, end]. They allow for curved paths, for
    /// oscillating walls and for discs that a wall has hit; see Dynamics::walls_between.
    Extent walls_between(double begin, double end) const;
    /// The time at which the disc meets the low or the high side of this axis, or `never`.
    double wall_time(const DiscState& disc, Axis axis, const Body& body) const {
        return meeting(disc, axis, body).time;
    }
    /// Carries out the collision at `time` = wall_time(disc, axis, body) in the event-driven
    /// method. `body` has the disc's properties at the time of its state, and `then` those at
    /// `time`. Here and below, `spin` is null if discs do not turn.
    Loss bounce(DiscState& disc, Axis axis, double time, const Body& body, const Body& then,
                double* spin) const;
    /// Returns false only if the disc certainly meets no wall before `time`. `margin` is a distance
    /// that allows for rounding.
    bool may_meet(const DiscState& disc, double time, double margin, const Body& body) const;

    /// The side of this axis towards which the disc flies; its velocity along it must not be 0.
    static std::size_t side_ahead(const DiscState& disc, Axis axis) {
        return 2 * static_cast<std::size_t>(axis) +
               (velocity_of(disc, static_cast<std::size_t>(axis)) < 0 ? 0 : 1);
    }
    bool is_open(std::size_t side) const { return sides_[side].kind == BoundaryKind::open; }
    bool is_open_ahead(const DiscState& disc, Axis axis) const {
        return is_open(side_ahead(disc, axis));
    }
    bool are_any_open() const { return is_open(0) || is_open(1) || is_open(2) || is_open(3); }
    /// The coordinate, in the box, of the centre of a disc that has just left through this side.
    double departure(std::size_t side, const Body& body) const {
        return departure_or_touch(side, body.radius);
    }
    /// Marks a disc that has reached the coordinate `departure` as departed, and advances its state
    /// to `time`.
    void depart(DiscState& disc, std::size_t side, double time, const Body& body,
                double* spin) const;

    /// Time-stepped method: reflects a disc from the wall at rest that it touches along `axis`.
    void reverse(DiscState& disc, Axis axis, const Body& body, double* spin) const;

private:
    struct Meeting {
        double time = never;
        std::size_t side = 0;
    };
    /// A disc's distance to the wall, the rate at which it changes on the frame's clock, and the
    /// disc's acceleration relative to the wall, at the time of the disc's state. All are positive
    /// away from the wall. If the disc grows, the rate includes the growth.
    struct Approach {
        double distance, rate, pull;
    };

    static double place_of(const DiscState& disc, std::size_t axis) {
        return axis == 0 ? disc.x : disc.y;
    }
    static double velocity_of(const DiscState& disc, std::size_t axis) {
        return axis == 0 ? disc.vx : disc.vy;
    }
    static double sign_of(std::size_t side) { return side % 2 == 0 ? 1 : -1; }

    /// The length of the box from this side to the opposite one.
    double length_of(std::size_t side) const { return side / 2 == 0 ? box_.x : box_.y; }
    /// The number of the side that the random numbers of thermal walls depend on. It is the same
    /// for a tall box and for that box turned on its side.
    std::size_t drawn_side(std::size_t side) const {
        return longer_axis(box_) == Axis::x ? side : (side + 2) % 4;
    }
    double departure_or_touch(std::size_t side, double radius) const {
        const double from_line = is_open(side) ? -radius : radius;
        return side % 2 == 0 ? from_line : length_of(side) - from_line;
    }
    /// The coordinate of the centre of a disc of this radius that touches the wall, or that has
    /// just left through an open side. For an oscillating wall this function and `wall_velocity`
    /// describe the line about which it oscillates.
    double wall_at(std::size_t side, double time, double radius) const {
        const double place = departure_or_touch(side, radius) + moved_[side];
        const double fallen = fall_.fallen(pull_at(side), time);
        if (!sways_along(side)) [[likely]]
            return (place + speeds_[side] * time) - fallen;
        return (place + speeds_[side] * time) - (fallen + fall_.sway().at(side / 2, time).way);
    }
    /// Whether the acceleration normal to the side changes in time.
    bool sways_along(std::size_t side) const { return fall_.sway().acts_along(side / 2); }
    /// The steady acceleration, along +x or +y, of a disc that moves with the wall. It includes the
    /// drag on the disc.
    double pull_at(std::size_t side) const { return pull_[side / 2] - drag_ * speeds_[side]; }
    /// An upper bound of the magnitude of `pull_at` plus the acceleration that changes in time.
    double largest_pull_at(std::size_t side) const {
        return std::fabs(pull_at(side)) + std::fabs(sways_[side / 2]);
    }
    double wall_velocity(std::size_t side, double time) const {
        const double velocity = speeds_[side] - pull_at(side) * fall_.falling_time(time);
        if (!sways_along(side)) [[likely]]
            return velocity;
        return velocity - fall_.sway().at(side / 2, time).speed;
    }
    double oscillating_velocity(std::size_t side, double time) const {
        return wall_velocity(side, time) + oscillations_[side].at(time).velocity;
    }
    Extent extent_of_lines(double time) const;
    Approach approach(const DiscState& disc, std::size_t side, const Body& body) const {
        const double sign = sign_of(side);
        return {sign * (place_of(disc, side / 2) - wall_at(side, disc.tau, body.radius)),
                sign * (velocity_of(disc, side / 2) - wall_velocity(side, disc.tau)) -
                    body.outwards,
                sign * pull_at(side)};
    }
    double delay_of(const Approach& approach, double time) const;
    double delay_to(const DiscState& disc, std::size_t side, const Body& body) const;
    Meeting meeting(const DiscState& disc, Axis axis, const Body& body) const;
    Loss rebound(DiscState& disc, std::size_t side, double since, double time, const Body& body,
                 double* spin) const;
    /// The velocity of the wall's surface along the wall, towards +x or +y, in the frame.
    double surface_velocity(std::size_t side, double time) const {
        const double velocity = sides_[side].surface.velocity / fall_.slowing_at(time) -
                                pull_[1 - side / 2] * fall_.falling_time(time);
        if (!fall_.sway().is_on()) [[likely]]
            return velocity;
        return velocity - fall_.sway().at(1 - side / 2, time).speed;
    }
    double pressure_at(std::size_t side, double time) const;
    /// 1 if the tangent t (rubbing.hpp) at this side points along +x or +y, otherwise -1.
    static double sign_along(std::size_t side) { return side == 0 || side == 3 ? 1 : -1; }

    std::array<Boundary, 4> sides_;
    ContactGuard guard_;
    double drag_;
    std::uint64_t thermal_seed_;
    Box box_;
    double radius_;
    /// Added to the positions of the sides: infinite for periodic sides, otherwise 0
    std::array<double, 4> away_{};
    /// `moved_`: how far the walls have moved from the scene's start to the last sync
    std::array<double, 4> moved_{}, speeds_{};
    /// The steady part of the acceleration, and the amplitudes of the part that changes in time
    std::array<double, 2> pull_, sways_;
    FallingFrame fall_;
    std::array<Oscillation, 4> oscillations_{};
    /// For each side, the duration of a small bounce of a resting disc; 0 if neither this side nor
    /// the acceleration oscillates
    std::array<double, 4> rest_times_{};
    std::array<SurfaceTable, 4> surfaces_{};
};

} // namespace carrom

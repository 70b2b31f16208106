// SPDX-License-Identifier: BSD-3-Clause
// The dynamics of a scene that names no effect: free flight, elastic pairs, four elastic walls at
// rest (docs/understanding/method.md, sections 3 and 4). Its answers are those of dynamics.hpp.
//
// A dynamics with effects is derived from it and replaces some answers. The others use
// the parts at the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/axis.hpp"
#include "core/disc_state.hpp"
#include "core/flight_integral.hpp"
#include "core/frame.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/pair_contact.hpp"
#include "dynamics/resting_walls.hpp"

namespace carrom {

/// The walls of a bounce.
struct MetWalls {
    bool at_x = false, at_y = false;
};

/// The vector from one disc's centre to another one's.
struct Separation {
    double x = 0, y = 0;
};

/// Two discs that touch: the separation of the second one's centre from the first
/// one's, and its relative velocity.
struct Encounter {
    double ex = 0, ey = 0;
    double wx = 0, wy = 0;

    double square() const { return ex * ex + ey * ey; }
    /// How fast they come apart, in units of their distance.
    double rate() const { return (wx * ex + wy * ey) / (ex * ex + ey * ey); }
};

class PlainDynamics {
public:
    static constexpr double never = std::numeric_limits<double>::infinity();
    static constexpr bool is_for_study = false;
    static constexpr bool is_periodic = false;
    static constexpr bool has_moving_images = false;
    static constexpr bool has_species = false;
    static constexpr bool has_spin = false;
    static constexpr bool has_mirror_walls = true;
    static constexpr bool has_elastic_pairs = true;
    static constexpr bool may_have_obstacles = false;
    static constexpr bool may_lose_discs = false;
    static constexpr double cascade_interval = 0x1p-40;

    PlainDynamics(const Box& box, double radius)
        : box_(box), radius_(radius), diameter_(2 * radius), band_(1e-8 * radius),
          tolerance_(std::max(1e-12 * diameter_, 16 * 0x1p-52 * box.longest())) {}

    static constexpr bool has_pairs() { return true; }
    static constexpr bool has_walls() { return true; }
    static constexpr bool has_obstacles() { return false; }
    static constexpr bool has_open_sides() { return false; }
    static constexpr bool parts_overlaps() { return true; }

    const Box& box() const { return box_; }
    double radius() const { return radius_; }
    double diameter() const { return diameter_; }
    double tolerance() const { return tolerance_; }
    static constexpr double slack() { return 0; }
    double search_diameter() const { return diameter_; }
    static constexpr double growth_at(double /*time*/) { return 1; }

    // Clock and frame are the box's own.
    void begin_interval(std::int64_t /*n*/) {}
    static constexpr double clock_at(double micro_steps) { return micro_steps; }
    static constexpr double micro_steps_at(double clock) { return clock; }
    static Frame frame_at(double /*time*/) { return {}; }
    /// Whether frame or clock differ from the box's at any time.
    static constexpr bool has_own_frame() { return false; }
    static constexpr double slowing_at(double /*time*/) { return 1; }
    static FlightIntegral flight_integral_at(double time) { return {time, 0, 0, 0, 0}; }
    static constexpr double pair_weight_at(double time) { return time; }
    static void restart_frame(DiscState& /*disc*/, double /*time*/) {}
    static constexpr double jump_at(Axis /*axis*/, double /*time*/) { return 0; }
    static constexpr double speed_gained_at(double /*time*/) { return 0; }
    Extent extent_at(double /*time*/) const { return {0, box_.x, 0, box_.y}; }

    static void advance(DiscState& disc, double time) {
        const double x = disc.x_at(time), y = disc.y_at(time);
        disc.x = x;
        disc.y = y;
        disc.tau = time;
    }

    /// From p to q, which are both at the place of their collision.
    static Separation separation(const DiscState& p, const DiscState& q) {
        return {q.x - p.x, q.y - p.y};
    }
    /// From p to q, which are both at `time`, or fly there.
    static Separation separation_at(const DiscState& p, const DiscState& q, double time) {
        return {q.x_at(time) - p.x_at(time), q.y_at(time) - p.y_at(time)};
    }
    static constexpr double mass_of(const DiscState& /*disc*/) { return 1; }
    /// The squared speed that searches have to allow for: the disc's own, now and at `time`.
    static double squared_speed(const DiscState& disc) { return squared_speed_of(disc); }
    static double squared_speed_at(const DiscState& disc, double /*time*/) {
        return squared_speed_of(disc);
    }

    // The time-stepped method.

    PairContact<double> contact(const DiscState& p, const DiscState& q) const {
        return pair_contact(p, q, diameter_, tolerance_);
    }
    void collide(DiscState& p, DiscState& q, double m, double t) const {
        collide_at(p, q, m + t);
        stop_at_wall(p, m, t);
        stop_at_wall(q, m, t);
    }
    double wall_time(const DiscState& disc, double m) const {
        return std::min(axis_time(Axis::x, disc, m), axis_time(Axis::y, disc, m));
    }
    /// A corner reverses both velocities and counts once.
    void bounce(DiscState& disc, double m, double t, double* /*spin*/ = nullptr) const {
        const MetWalls met = reach_walls(disc, m, t);
        if (met.at_x) disc.vx = -disc.vx;
        if (met.at_y) disc.vy = -disc.vy;
        disc.wall_collisions += 1;
        stop_at_wall(disc, m, t);
    }
    MetWalls met_walls(const DiscState& before, double m, double t) const {
        DiscState disc = before;
        return reach_walls(disc, m, t);
    }

    // The event-driven method.

    [[gnu::always_inline]] PairContact<double> event_contact(const DiscState& p,
                                                             const DiscState& q) const {
        return pair_contact(p, q, diameter_, never);
    }
    static Loss collide_at(DiscState& p, DiscState& q, double time) {
        advance(p, time);
        advance(q, time);
        push_apart(p, q, encounter(p, q, q.x - p.x, q.y - p.y), 1);
        return {};
    }
    double x_wall_time(const DiscState& disc) const {
        return disc.tau + walls(Axis::x).delay(disc.x, disc.vx);
    }
    double y_wall_time(const DiscState& disc) const {
        return disc.tau + walls(Axis::y).delay(disc.y, disc.vy);
    }
    bool may_meet_wall(const DiscState& disc, double time) const {
        const double x = disc.x_at(time), y = disc.y_at(time);
        // The last term allows for rounded times, in which a fast disc flies some way.
        const double margin = tolerance_ + time_rounding * time *
                                               std::max(std::fabs(disc.vx), std::fabs(disc.vy));
        const RestingWalls<double> at_x = walls(Axis::x), at_y = walls(Axis::y);
        return !(x > at_x.low() + margin && x < at_x.high() - margin && y > at_y.low() + margin &&
                 y < at_y.high() - margin);
    }
    Extent walls_between(double /*begin*/, double /*end*/) const { return {0, box_.x, 0, box_.y}; }
    static Loss bounce_x_at(DiscState& disc, double time, double* /*spin*/ = nullptr) {
        advance(disc, time);
        disc.vx = -disc.vx;
        disc.wall_collisions += 1;
        return {};
    }
    static Loss bounce_y_at(DiscState& disc, double time, double* /*spin*/ = nullptr) {
        advance(disc, time);
        disc.vy = -disc.vy;
        disc.wall_collisions += 1;
        return {};
    }

    // Parts of the answers above, for other dynamics.

    /// These walls and pairs for a pair whose radii have the sum `diameter`, or for a
    /// disc of another `radius` at walls. Band and tolerance stay the same.
    PlainDynamics with_sizes(double radius, double diameter) const {
        PlainDynamics dynamics = *this;
        dynamics.radius_ = radius;
        dynamics.diameter_ = diameter;
        return dynamics;
    }

    [[gnu::always_inline]] double axis_time(Axis axis, const DiscState& disc, double m) const {
        return walls(axis).time(along(axis, disc.x, disc.y), along(axis, disc.vx, disc.vy),
                                disc.tau, m);
    }
    [[gnu::always_inline]] double axis_stop(Axis axis, const DiscState& disc, double rest) const {
        return walls(axis).stop(along(axis, disc.x, disc.y), along(axis, disc.vx, disc.vy), rest);
    }
    bool touches_wall(Axis axis, const DiscState& disc) const {
        return walls(axis).touches(along(axis, disc.x, disc.y), along(axis, disc.vx, disc.vy));
    }

    /// A disc that would leave the box before the micro-step ends waits at the wall. It bounces in
    /// the next one.
    [[gnu::always_inline]] void stop_at_wall(DiscState& disc, double m, double t) const {
        const double rest = 1 - t;
        const double stop = std::min(axis_stop(Axis::x, disc, rest),
                                     axis_stop(Axis::y, disc, rest));
        if (stop == never) return;
        disc.x = disc.x + disc.vx * stop;
        disc.y = disc.y + disc.vy * stop;
        disc.tau = m + 1;
    }

protected:
    static constexpr double time_rounding = 0x1p-50;

    /// The encounter of two discs at a separation (ex, ey) from p to q.
    [[gnu::always_inline]] static Encounter encounter(const DiscState& p, const DiscState& q,
                                                      double ex, double ey) {
        return {ex, ey, q.vx - p.vx, q.vy - p.vy};
    }

    /// Gives new velocities to discs that touch. `impulse` is in units of that of an
    /// elastic contact of equal masses, of which p and q take their shares.
    /// Multiplying by 1 changes no bit, and takes no instruction.
    [[gnu::always_inline]] static void push_apart(DiscState& p, DiscState& q,
                                                  const Encounter& encounter, double impulse,
                                                  double p_share = 1, double q_share = 1) {
        const double ex = encounter.ex, ey = encounter.ey;
        const double k = impulse * encounter.rate();
        p.vx = p.vx + k * p_share * ex;
        p.vy = p.vy + k * p_share * ey;
        q.vx = q.vx - k * q_share * ex;
        q.vy = q.vy - k * q_share * ey;
        p.pair_collisions += 1;
        q.pair_collisions += 1;
    }

    [[gnu::always_inline]] RestingWalls<double> walls(Axis axis) const {
        return {along(axis, box_), radius_, band_};
    }

    Box box_;
    double radius_, diameter_, band_, tolerance_;

private:
    /// Advances the disc to in-step time t = wall_time(disc, m).
    [[gnu::always_inline]] MetWalls reach_walls(DiscState& disc, double m, double t) const {
        const double x_time = axis_time(Axis::x, disc, m), y_time = axis_time(Axis::y, disc, m);
        advance(disc, m + t);
        return {x_time == t || touches_wall(Axis::x, disc),
                y_time == t || touches_wall(Axis::y, disc)};
    }
};

} // namespace carrom

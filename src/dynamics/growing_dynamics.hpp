// SPDX-License-Identifier: BSD-3-Clause
// Discs whose radii grow at a constant rate, r(t) = r(0) (1 + rate t), as Lubachevsky and
// Stillinger (J. Stat. Phys. 60, 561 (1990)) compress them. Event-driven method only.
//
// Radii follow from the time since the scene's start, so no state has them. Surfaces that meet part
// as elastic ones do, seen from the moving surfaces. One class serves walls and periodic sides, one
// species and several: sides ask when they run, and a box without periodic sides has no images.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "dynamics/growing_contact.hpp"
#include "dynamics/periodic_dynamics.hpp"

namespace carrom {

class GrowingDynamics : public PeriodicDynamics<MixedDynamics> {
    using Constant = PeriodicDynamics<MixedDynamics>;

public:
    static constexpr bool may_have_obstacles = false;
    /// Discs that jam collide ever faster as long as they grow, so a run should end
    /// before it takes hours.
    static constexpr double cascade_interval = 0x1p-10;

    /// `effects` are per micro-step.
    GrowingDynamics(const Box& box, double radius, const Effects& effects)
        : Constant(box, radius, effects), rate_(effects.growth), guard_(effects, radius) {
        for (std::size_t side = 0; side < restitutions_.size(); ++side)
            restitutions_[side] = effects.boundaries[side].restitution;
    }

    void begin_interval(std::int64_t n) {
        Constant::begin_interval(n);
        at_sync_ = 1 + rate_ * static_cast<double>(n);
    }
    double growth_at(double time) const { return at_sync_ + rate_ * time; }

    PairContact<double> event_contact(const DiscState& p, const DiscState& q) const {
        const double base = std::max(p.tau, q.tau), size = growth_at(base);
        const double dx = (q.x_at(base) - p.x_at(base)) + periods().x_between(p, q);
        const double dy = (q.y_at(base) - p.y_at(base)) + periods().y_between(p, q);
        return {base, growing_contact_delay(dx, dy, q.vx - p.vx, q.vy - p.vy,
                                            pair_diameter(p, q) * size, rate_ / size, never)};
    }
    /// Along the line of centres the surfaces' relative velocity is reversed.
    Loss collide_at(DiscState& p, DiscState& q, double time) const {
        const double since = since_collision_of(p, q, time), growth = rate_ / growth_at(time);
        advance(p, time);
        advance(q, time);
        const double ex = (q.x - p.x) + periods().x_between(p, q),
                     ey = (q.y - p.y) + periods().y_between(p, q);
        const double wx = std::fma(-growth, ex, q.vx - p.vx),
                     wy = std::fma(-growth, ey, q.vy - p.vy);
        const Encounter of_surfaces{ex, ey, wx, wy};
        const double rate = of_surfaces.rate();
        const bool is_guarded = contact_.is_guarded(since, rate);
        const double k = is_guarded ? rate : contact_.normal() * rate;
        const double p_mass = mass_of(p), q_mass = mass_of(q), half = (p_mass + q_mass) / 2;
        p.vx = p.vx + k * (q_mass / half) * ex;
        p.vy = p.vy + k * (q_mass / half) * ey;
        q.vx = q.vx - k * (p_mass / half) * ex;
        q.vy = q.vy - k * (p_mass / half) * ey;
        p.pair_collisions += 1;
        q.pair_collisions += 1;
        p.has_collided = q.has_collided = 1;
        return contact_.loss(p_mass * q_mass / (2 * half) * normal_loss(rate) *
                                 of_surfaces.square(),
                             rate * rate * of_surfaces.square(), is_guarded);
    }

    double x_wall_time(const DiscState& disc) const { return meeting(disc, Axis::x).time; }
    double y_wall_time(const DiscState& disc) const { return meeting(disc, Axis::y).time; }
    Loss bounce_x_at(DiscState& disc, double time, double* /*spin*/ = nullptr) const {
        return bounce_at(disc, Axis::x, time);
    }
    Loss bounce_y_at(DiscState& disc, double time, double* /*spin*/ = nullptr) const {
        return bounce_at(disc, Axis::y, time);
    }
    bool may_meet_wall(const DiscState& disc, double time) const {
        const double first_radius = species_table().of(disc.id).radius,
                     radius = first_radius * growth_at(time);
        const double fastest = std::max(std::fabs(disc.vx), std::fabs(disc.vy)) +
                               first_radius * rate_;
        const double least = radius + (tolerance() + time_rounding * time * fastest);
        const auto is_clear = [&](double place, double period, double length) {
            return period != 0 || (place > least && place < length - least);
        };
        return !(is_clear(disc.x_at(time), periods().x, box().x) &&
                 is_clear(disc.y_at(time), periods().y, box().y));
    }

private:
    struct Meeting {
        double time = never;
        bool is_high = false;
    };

    /// The surface comes nearer to a wall at a constant rate: one division.
    static double wall_delay(double gap, double closing) {
        if (!(closing > 0)) return never;
        return gap > 0 ? gap / closing : 0;
    }
    Meeting meeting(const DiscState& disc, Axis axis) const {
        const bool is_x = axis == Axis::x;
        if ((is_x ? periods().x : periods().y) != 0) return {};
        const double place = is_x ? disc.x : disc.y, velocity = is_x ? disc.vx : disc.vy;
        const double first_radius = species_table().of(disc.id).radius,
                     radius = first_radius * growth_at(disc.tau), grows = first_radius * rate_;
        const double to_low = wall_delay(place - radius, grows - velocity),
                     to_high = wall_delay((along(axis, box()) - radius) - place, grows + velocity);
        return to_low <= to_high ? Meeting{disc.tau + to_low, false}
                                 : Meeting{disc.tau + to_high, true};
    }
    /// Like a bounce at a wall that comes in as fast as the disc grows.
    Loss bounce_at(DiscState& disc, Axis axis, double time) const {
        const bool is_high = meeting(disc, axis).is_high;
        const double restitution =
            restitutions_[2 * static_cast<std::size_t>(axis) + (is_high ? 1 : 0)];
        const double since = since_collision(disc, time),
                     first_radius = species_table().of(disc.id).radius,
                     grows = first_radius * rate_;
        advance(disc, time);
        double& velocity = axis == Axis::x ? disc.vx : disc.vy;
        const double closing = grows + (is_high ? velocity : -velocity);
        const bool is_guarded = guard_.holds_at_wall(since, closing,
                                                     first_radius * growth_at(time));
        const double away = grows + (is_guarded ? 1 : restitution) * closing;
        velocity = is_high ? -away : away;
        disc.wall_collisions += 1;
        disc.has_collided = 1;
        const double square = closing * closing;
        return guard_.loss(0.5 * mass_of(disc) * (1 - restitution * restitution) * square, square,
                           is_guarded);
    }

    double rate_;
    ContactGuard guard_;
    std::array<double, 4> restitutions_{};
    double at_sync_ = 1; ///< the factor by which radii had grown at the last sync
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The dynamics of boxes with periodic sides: another dynamics, applied to images of
// discs (core/image.hpp).
//
// The separation of two discs is that of their stored places and a whole number of box
// lengths, added in one fixed association. An axis has walls or is periodic. All other
// answers are those of the other dynamics.
#pragma once

#include "core/image.hpp"
#include "dynamics/effect_dynamics.hpp"

namespace carrom {

template <class Walled> class PeriodicDynamics : public Walled {
public:
    static constexpr bool is_periodic = true;
    static constexpr bool may_lose_discs = false; // a side is periodic or open

    /// `effects` per micro-step.
    PeriodicDynamics(const Box& box, double radius, const Effects& effects)
        : Walled(box, radius, effects), periods_(effects.periods(box)) {}

    const Periods& periods() const { return periods_; }
    bool has_walls() const { return periods_.x == 0 || periods_.y == 0 || this->has_obstacles(); }
    /// Places are rounded as coarsely as stored ones are far from the box.
    double slack() const { return 0x1p-36 * this->box().longest(); }
    double search_diameter() const { return this->diameter() + 2 * slack(); }

    Separation separation(const DiscState& p, const DiscState& q) const {
        return {(q.x - p.x) + periods_.x_between(p, q), (q.y - p.y) + periods_.y_between(p, q)};
    }
    Separation separation_at(const DiscState& p, const DiscState& q, double time) const {
        const Separation stored = Walled::separation_at(p, q, time);
        return {stored.x + periods_.x_between(p, q), stored.y + periods_.y_between(p, q)};
    }

    PairContact<double> contact(const DiscState& p, const DiscState& q) const {
        return contact(p, q, this->tolerance());
    }
    PairContact<double> event_contact(const DiscState& p, const DiscState& q) const {
        return contact(p, q, Walled::never);
    }

    void collide(DiscState& p, DiscState& q, double m, double t) const {
        exchange_momentum(p, q, m + t, Walled::never);
        stop(p, m, t);
        stop(q, m, t);
    }
    Loss collide_at(DiscState& p, DiscState& q, double time) const {
        return exchange_momentum(p, q, time, this->since_collision_of(p, q, time));
    }

    /// For rough discs.
    void collide(DiscState& p, DiscState& q, double m, double t, double& p_spin,
                 double& q_spin) const {
        exchange_spin(p, q, m + t, Walled::never, p_spin, q_spin);
        stop(p, m, t);
        stop(q, m, t);
    }
    Loss collide_at(DiscState& p, DiscState& q, double time, double& p_spin, double& q_spin) const {
        return exchange_spin(p, q, time, this->since_collision_of(p, q, time), p_spin, q_spin);
    }

    double wall_time(const DiscState& disc, double m) const {
        const double at_wall = side_time(disc, m);
        return this->has_obstacles() ? std::min(at_wall, this->obstacle_contact(disc, m).time - m)
                                     : at_wall;
    }
    MetWalls met_walls(const DiscState& disc, double m, double t) const {
        if (this->has_obstacles() && t != side_time(disc, m)) return {};
        return {periods_.x == 0, periods_.y == 0};
    }
    /// There is one axis with walls at most, and so no corner.
    void bounce(DiscState& disc, double m, double t, double* spin = nullptr) const {
        if (this->has_obstacles() && t != side_time(disc, m))
            return stop(disc, m, t, this->rebound_in(disc, m, spin));
        this->advance(disc, m + t);
        this->reverse(disc, periods_.x == 0 ? Axis::x : Axis::y, spin);
        disc.wall_collisions += 1;
        stop(disc, m, t);
    }

    /// Brings a state that a sync has just rewritten into the box.
    void wrap(DiscState& disc) const { periods_.wrap(disc, disc.tau); }

protected:
    Periods periods_;

private:
    [[gnu::flatten]] PairContact<double> contact(const DiscState& p, const DiscState& q,
                                                 double deepest_overlap) const {
        const double base = std::max(p.tau, q.tau);
        const double dx = (q.x_at(base) - p.x_at(base)) + periods_.x_between(p, q);
        const double dy = (q.y_at(base) - p.y_at(base)) + periods_.y_between(p, q);
        return {base, contact_delay(dx, dy, q.vx - p.vx, q.vy - p.vy, this->pair_diameter(p, q),
                                    deepest_overlap)};
    }

    Loss exchange_momentum(DiscState& p, DiscState& q, double time, double since) const {
        this->advance(p, time);
        this->advance(q, time);
        const Separation to = separation(p, q);
        return this->exchange_momentum_at(p, q, this->encounter(p, q, to.x, to.y), since);
    }
    Loss exchange_spin(DiscState& p, DiscState& q, double time, double since, double& p_spin,
                       double& q_spin) const {
        this->advance(p, time);
        this->advance(q, time);
        const Separation to = separation(p, q);
        return this->exchange_spin_at(p, q, this->encounter(p, q, to.x, to.y), since, p_spin,
                                      q_spin);
    }

    double side_time(const DiscState& disc, double m) const {
        if (periods_.x == 0) return this->wall_dynamics(disc).axis_time(Axis::x, disc, m);
        return periods_.y == 0 ? this->wall_dynamics(disc).axis_time(Axis::y, disc, m)
                               : Walled::never;
    }

    void stop(DiscState& disc, double m, double t,
              std::uint32_t left = ObstacleContact::no_body) const {
        const bool has_sides = periods_.x == 0 || periods_.y == 0;
        if (!has_sides && !this->has_obstacles()) return;
        const double rest = 1 - t;
        const PlainDynamics walls = this->wall_dynamics(disc);
        const double at_wall = !has_sides        ? Walled::never
                               : periods_.x == 0 ? walls.axis_stop(Axis::x, disc, rest)
                                                 : walls.axis_stop(Axis::y, disc, rest);
        this->stop_at(disc, m, at_wall, left);
    }
};

/// The usual gas in a periodic box.
using PeriodicElasticDynamics = PeriodicDynamics<EffectDynamics<ElasticContact>>;
using PeriodicInelasticDynamics = PeriodicDynamics<InelasticDynamics>;
using PeriodicMixedDynamics = PeriodicDynamics<MixedDynamics>;
using PeriodicRoughDynamics = PeriodicDynamics<RoughDynamics>;

} // namespace carrom

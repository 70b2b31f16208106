// SPDX-License-Identifier: BSD-3-Clause
// The dynamics of scenes that name effects, put together from a contact (contacts.hpp), the sides
// of the box (boundaries.hpp), the falling frame (gravity.hpp) and obstacles (obstacles.hpp).
//
// It is the plain dynamics with some answers replaced. The plain dynamics' own code computes
// everything that an effect leaves alone. So an effect whose parameters make it none gives the
// plain bits.
#pragma once

#include <memory>

#include "dynamics/boundaries.hpp"
#include "dynamics/contacts.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/gravity.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/obstacles.hpp"
#include "dynamics/plain_dynamics.hpp"

namespace carrom {

/// `is_mixed` means several radii and masses. The radius is then the largest one, and
/// band and tolerance belong to it.
template <class Contact, bool is_mixed = false> class EffectDynamics : public PlainDynamics {
public:
    static constexpr bool has_species = is_mixed;
    static constexpr bool has_spin = std::is_same_v<Contact, RoughContact>;
    static constexpr bool has_mirror_walls = false;
    static constexpr bool has_elastic_pairs = std::is_same_v<Contact, ElasticContact>;
    static constexpr bool may_have_obstacles = true;
    static constexpr bool may_lose_discs = true;

    /// `effects` per micro-step.
    EffectDynamics(const Box& box, double radius, const Effects& effects)
        : PlainDynamics(box, radius), contact_(effects, radius),
          has_pairs_(effects.contact.kind != ContactKind::none), species_(effects.species, radius),
          fall_(effects.gravity, effects.drag), boundaries_(box, radius, effects, species_) {
        if (effects.obstacles.are_any())
            obstacles_ = std::make_shared<const Obstacles>(box, radius, effects);
    }

    /// False in an ideal gas: discs pass through each other.
    bool has_pairs() const { return has_pairs_; }
    bool has_obstacles() const { return obstacles_ != nullptr; }
    bool has_open_sides() const { return boundaries_.are_any_open(); }
    const SpeciesTable& species_table() const { return species_; }
    double mass_of(const DiscState& disc) const {
        if constexpr (is_mixed) return species_.of(disc.id).mass;
        return 1;
    }

    void begin_interval(std::int64_t n) { boundaries_.begin_interval(n); }
    double clock_at(double micro_steps) const { return fall_.clock_at(micro_steps); }
    double micro_steps_at(double clock) const { return fall_.micro_steps_at(clock); }
    Frame frame_at(double time) const { return fall_.at(time); }
    bool has_own_frame() const { return fall_.is_any(); }
    double slowing_at(double time) const { return fall_.slowing_at(time); }
    FlightIntegral flight_integral_at(double time) const { return fall_.flight_integral_at(time); }
    double pair_weight_at(double time) const { return fall_.pair_weight_at(time); }
    void restart_frame(DiscState& disc, double time) const { fall_.restart(disc, time); }
    double jump_at(Axis axis, double time) const { return fall_.jump_at(axis, time); }
    double speed_gained_at(double time) const { return fall_.speed_gained_at(time); }
    Extent extent_at(double time) const { return boundaries_.extent_at(time); }

    PairContact<double> contact(const DiscState& p, const DiscState& q) const {
        if (p.has_departed() || q.has_departed()) return {};
        return pair_dynamics(p, q).contact(p, q);
    }
    PairContact<double> event_contact(const DiscState& p, const DiscState& q) const {
        if (p.has_departed() || q.has_departed()) return {};
        return pair_dynamics(p, q).event_contact(p, q);
    }

    void collide(DiscState& p, DiscState& q, double m, double t) const {
        exchange_momentum(p, q, m + t, never);
        stop(p, m, t);
        stop(q, m, t);
    }
    Loss collide_at(DiscState& p, DiscState& q, double time) const {
        return exchange_momentum(p, q, time, since_collision_of(p, q, time));
    }

    /// The plain dynamics' answer, with obstacles.
    MetWalls met_walls(const DiscState& disc, double m, double t) const {
        if (has_obstacles() && t != side_time(disc, m)) return {};
        return wall_dynamics(disc).met_walls(disc, m, t);
    }

    /// For rough discs: spins are angles per micro-step, counterclockwise.
    void collide(DiscState& p, DiscState& q, double m, double t, double& p_spin,
                 double& q_spin) const {
        exchange_spin(p, q, m + t, never, p_spin, q_spin);
        stop(p, m, t);
        stop(q, m, t);
    }
    Loss collide_at(DiscState& p, DiscState& q, double time, double& p_spin, double& q_spin) const {
        return exchange_spin(p, q, time, since_collision_of(p, q, time), p_spin, q_spin);
    }

    /// A disc's candidate with a wall or an obstacle, whichever comes first.
    double wall_time(const DiscState& disc, double m) const {
        const double at_wall = side_time(disc, m);
        return has_obstacles() ? std::min(at_wall, obstacle_contact(disc, m).time - m) : at_wall;
    }

    /// The plain dynamics' times; the sides decide what happens at them. In the time-stepped method
    /// walls are at rest.
    /// `spin`, here and below: that of a rough disc, null of others.
    void bounce(DiscState& disc, double m, double t, double* spin = nullptr) const {
        if (has_obstacles() && t != side_time(disc, m)) return bounce_off(disc, m, t, spin);
        const PlainDynamics walls = wall_dynamics(disc);
        const double tx = side_time(disc, Axis::x, m), ty = side_time(disc, Axis::y, m);
        advance(disc, m + t);
        if (tx == t && is_open(disc, Axis::x))
            return boundaries_.depart(disc, Boundaries::side_ahead(disc, Axis::x), m + t, spin);
        if (ty == t && is_open(disc, Axis::y))
            return boundaries_.depart(disc, Boundaries::side_ahead(disc, Axis::y), m + t, spin);
        const bool x_reverses = tx == t ||
                                (walls.touches_wall(Axis::x, disc) && !is_open(disc, Axis::x));
        const bool y_reverses = ty == t ||
                                (walls.touches_wall(Axis::y, disc) && !is_open(disc, Axis::y));
        const bool goes_down = disc.vy < 0;
        if (x_reverses) boundaries_.reverse(disc, Axis::x, spin);
        // A thermal wall may have turned the disc away from the other one.
        if (y_reverses && (goes_down ? disc.vy < 0 : disc.vy > 0))
            boundaries_.reverse(disc, Axis::y, spin);
        disc.wall_collisions += 1;
        stop(disc, m, t);
    }

    double x_wall_time(const DiscState& disc) const { return boundaries_.wall_time(disc, Axis::x); }
    double y_wall_time(const DiscState& disc) const { return boundaries_.wall_time(disc, Axis::y); }
    bool may_meet_wall(const DiscState& disc, double time) const {
        const double fastest = std::max(std::fabs(disc.vx), std::fabs(disc.vy)) +
                               speed_gained_at(time);
        return boundaries_.may_meet(disc, time, tolerance() + time_rounding * time * fastest);
    }
    Extent walls_between(double begin, double end) const {
        return boundaries_.walls_between(begin, end);
    }
    Loss bounce_x_at(DiscState& disc, double time, double* spin = nullptr) const {
        return boundaries_.bounce_at(disc, Axis::x, time, spin);
    }
    Loss bounce_y_at(DiscState& disc, double time, double* spin = nullptr) const {
        return boundaries_.bounce_at(disc, Axis::y, time, spin);
    }
    /// The first obstacle that the disc comes to.
    ObstacleContact first_obstacle(const DiscState& disc, const ContactTimes& times) const {
        return disc.has_departed() ? ObstacleContact{}
                                   : obstacles_->first_contact(disc, radius_of(disc), times);
    }
    Loss bounce_off_at(DiscState& disc, std::uint32_t body, double time,
                       double* spin = nullptr) const {
        const double since = since_collision(disc, time);
        advance(disc, time);
        Loss loss = obstacles_->rebound(disc, body, time, since, {spin, radius_of(disc)});
        loss.taken *= mass_of(disc);
        loss.spared *= mass_of(disc);
        disc.wall_collisions += 1;
        disc.has_collided = 1;
        return loss;
    }

protected:
    void reverse(DiscState& disc, Axis axis, double* spin) const {
        boundaries_.reverse(disc, axis, spin);
    }

    ObstacleContact obstacle_contact(const DiscState& disc, double m) const {
        return first_obstacle(disc, {m, m + 1});
    }

    /// Reflects the disc from the obstacle that it comes to in the micro-step, and returns which
    /// that is.
    std::uint32_t rebound_in(DiscState& disc, double m, double* spin) const {
        const ObstacleContact contact = obstacle_contact(disc, m);
        advance(disc, contact.time);
        obstacles_->rebound(disc, contact.body, 0, never, {spin, radius_of(disc)});
        disc.wall_collisions += 1;
        return contact.body;
    }

    /// A disc that would run into an obstacle before the micro-step ends waits there. `at_wall`
    /// is the time at which a side stops it; `left` is the obstacle it has just left.
    void stop_at(DiscState& disc, double m, double at_wall, std::uint32_t left) const {
        const ObstacleContact contact = has_obstacles()
                                            ? first_obstacle(disc, {disc.tau, m + 1, true, left})
                                            : ObstacleContact{};
        if (contact.time < m + 1 && contact.time - disc.tau < at_wall) {
            advance(disc, contact.time);
        } else if (at_wall != never) {
            disc.x += disc.vx * at_wall;
            disc.y += disc.vy * at_wall;
        } else
            return;
        disc.tau = m + 1;
    }

private:
    double radius_of(const DiscState& disc) const {
        if constexpr (is_mixed) return species_.of(disc.id).radius;
        return radius_;
    }

    bool is_open(const DiscState& disc, Axis axis) const {
        return boundaries_.is_open(Boundaries::side_ahead(disc, axis));
    }

    /// The plain dynamics' answer for walls. Through an open side a disc leaves when
    /// its centre is a radius beyond it.
    double side_time(const DiscState& disc, Axis axis, double m) const {
        const double x = along(axis, disc.x, disc.y), v = along(axis, disc.vx, disc.vy);
        if (v == 0 || !is_open(disc, axis)) return wall_dynamics(disc).axis_time(axis, disc, m);
        const double line = boundaries_.departure(disc, Boundaries::side_ahead(disc, axis)),
                     at_end = x + v * ((m + 1) - disc.tau);
        if (v < 0 ? !(at_end < line) : !(at_end > line)) return never;
        return std::clamp((disc.tau - m) + (line - x) / v, 0.0, 1.0);
    }
    double side_time(const DiscState& disc, double m) const {
        return std::min(side_time(disc, Axis::x, m), side_time(disc, Axis::y, m));
    }
    double side_stop(const DiscState& disc, Axis axis, double rest) const {
        return along(axis, disc.vx, disc.vy) == 0 || is_open(disc, axis)
                   ? never
                   : wall_dynamics(disc).axis_stop(axis, disc, rest);
    }

    void bounce_off(DiscState& disc, double m, double t, double* spin) const {
        stop(disc, m, t, rebound_in(disc, m, spin));
    }

    void stop(DiscState& disc, double m, double t,
              std::uint32_t left = ObstacleContact::no_body) const {
        if (!has_obstacles() && !boundaries_.are_any_open())
            return wall_dynamics(disc).stop_at_wall(disc, m, t);
        stop_at(disc, m, std::min(side_stop(disc, Axis::x, 1 - t), side_stop(disc, Axis::y, 1 - t)),
                left);
    }

    [[gnu::always_inline]] PlainDynamics pair_dynamics(const DiscState& p,
                                                       const DiscState& q) const {
        if constexpr (is_mixed) return with_sizes(radius_, pair_diameter(p, q));
        return *this;
    }

    [[gnu::always_inline]] Loss exchange_momentum(DiscState& p, DiscState& q, double time,
                                                  double since) const {
        advance(p, time);
        advance(q, time);
        return exchange_momentum_at(p, q, encounter(p, q, q.x - p.x, q.y - p.y), since);
    }
    [[gnu::always_inline]] Loss exchange_spin(DiscState& p, DiscState& q, double time, double since,
                                              double& p_spin, double& q_spin) const {
        advance(p, time);
        advance(q, time);
        return exchange_spin_at(p, q, encounter(p, q, q.x - p.x, q.y - p.y), since, p_spin, q_spin);
    }

protected:
    // Sizes and masses of pairs and at walls, for images too. Discs are advanced to where they
    // touch. `since` is the time since the last collision of either.

    static double since_collision_of(const DiscState& p, const DiscState& q, double time) {
        return std::min(since_collision(p, time), since_collision(q, time));
    }

    /// Sums of two numbers are the same in any order.
    [[gnu::always_inline]] double pair_diameter(const DiscState& p, const DiscState& q) const {
        if constexpr (is_mixed) return species_.of(p.id).radius + species_.of(q.id).radius;
        return diameter_;
    }
    /// The plain dynamics of this disc at walls.
    [[gnu::always_inline]] PlainDynamics wall_dynamics(const DiscState& disc) const {
        if constexpr (is_mixed) return with_sizes(species_.of(disc.id).radius, diameter_);
        return *this;
    }

    /// The momentum that equal discs would exchange, times 2 m' / (m + m') for each disc's
    /// velocity, m' being the other's mass. The factor is 1 if the masses are equal.
    [[gnu::always_inline]] Loss exchange_momentum_at(DiscState& p, DiscState& q,
                                                     const Encounter& encounter,
                                                     double since) const {
        const double square = encounter.square(), k = encounter.rate();
        const bool is_guarded = contact_.is_guarded(since, k);
        const double impulse = is_guarded ? 1 : contact_.normal();
        double reduced_mass = 0.5;
        if constexpr (is_mixed) {
            const double p_mass = species_.of(p.id).mass, q_mass = species_.of(q.id).mass;
            const double half = (p_mass + q_mass) / 2;
            reduced_mass = p_mass * q_mass / (2 * half);
            push_apart(p, q, encounter, impulse, q_mass / half, p_mass / half);
        } else {
            push_apart(p, q, encounter, impulse);
        }
        p.has_collided = q.has_collided = 1;
        return contact_.loss(reduced_mass * normal_loss(k) * square, k * k * square, is_guarded);
    }

    /// The energy that restitution takes, for a reduced mass of 1 and a distance of 1: half of the
    /// squared rate of approach, times 1 - e^2.
    double normal_loss(double k) const {
        return 2 * contact_.normal() * (1 - contact_.normal()) * k * k;
    }

    /// Also adds an impulse s along the surfaces, which acts on both spins alike, in units of
    /// the distance of centres, like k. With s = 0 the bits are those of exchange_momentum_at.
    [[gnu::always_inline]] Loss exchange_spin_at(DiscState& p, DiscState& q,
                                                 const Encounter& encounter, double since,
                                                 double& p_spin, double& q_spin) const {
        const SizeAndMass &p_has = species_.of(p.id), &q_has = species_.of(q.id);
        const auto [ex, ey, wx, wy] = encounter;
        const double square = encounter.square(), distance = std::sqrt(square);
        const bool is_guarded = contact_.is_guarded(since, encounter.rate());
        const double lossy = contact_.normal() * encounter.rate();
        const double k = is_guarded ? encounter.rate() : lossy;
        const double slip = (wy * ex - wx * ey) / square -
                            (p_spin * p_has.radius + q_spin * q_has.radius) / distance;
        const double rubbed = contact_.tangential(slip, lossy), s = is_guarded ? 0 : rubbed;
        const double half = (p_has.mass + q_has.mass) / 2, p_share = q_has.mass / half,
                     q_share = p_has.mass / half;
        p.vx = p.vx + (k * p_share * ex - s * p_share * ey);
        p.vy = p.vy + (k * p_share * ey + s * p_share * ex);
        q.vx = q.vx - (k * q_share * ex - s * q_share * ey);
        q.vy = q.vy - (k * q_share * ey + s * q_share * ex);
        const double turn = s * distance / contact_.inertia();
        p_spin = p_spin + turn * p_share / p_has.radius;
        q_spin = q_spin + turn * q_share / q_has.radius;
        p.pair_collisions += 1;
        q.pair_collisions += 1;
        p.has_collided = q.has_collided = 1;
        // An impulse s changes the slip by 2 s (1 + 1 / inertia).
        const double along = 2 * rubbed * (slip - rubbed * (1 + 1 / contact_.inertia())),
                     rate = encounter.rate();
        return contact_.loss(p_has.mass * q_has.mass / (2 * half) * square *
                                 (normal_loss(rate) + along),
                             rate * rate * square, is_guarded);
    }

    Contact contact_;

private:
    bool has_pairs_;
    SpeciesTable species_;
    FallingFrame fall_;
    Boundaries boundaries_;
    std::shared_ptr<const Obstacles>
        obstacles_; ///< shared by all copies of this; null if there are no obstacles
};

using InelasticDynamics = EffectDynamics<InelasticContact>; ///< any restitution, also 1
using MixedDynamics = EffectDynamics<InelasticContact, true>;
using RoughDynamics = EffectDynamics<RoughContact, true>; ///< one species or several

} // namespace carrom

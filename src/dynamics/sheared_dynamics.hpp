// SPDX-License-Identifier: BSD-3-Clause
// The dynamics of uniform shear: a box whose images above and below move along x (A. W. Lees and
// S. F. Edwards, J. Phys. C 5, 1921 (1972)), so that the gas flows with vx = rate (y - const)
// without any wall.
//
// It is the dynamics of periodic sides with one more question to each pair: how fast is the image?
// The separation of two discs grows with the shift of their images, and their relative velocity has
// the image's velocity. Both are whole multiples of numbers of the scene, so that all ranks find
// the same bits. A disc that leaves through the seam keeps its stored state until the next sync,
// which brings it back with the velocity of the image in the box.
//
// Price: images near the seam are faster than discs in the box by rate times the box's height, and
// searches have to allow for that.
#pragma once

#include <cmath>

#include "dynamics/periodic_dynamics.hpp"

namespace carrom {

template <class Walled> class ShearedDynamics : public PeriodicDynamics<Walled> {
    using Resting = PeriodicDynamics<Walled>;

public:
    static constexpr bool has_moving_images = true;

    /// `effects` per micro-step.
    ShearedDynamics(const Box& box, double radius, const Effects& effects)
        : Resting(box, radius, effects) {}

    void begin_interval(std::int64_t n) {
        Resting::begin_interval(n);
        this->periods_.begin_interval(n);
    }

    // Kinetic stress is relative to the flow, and changes along a flight, so it is sampled.
    static FlightIntegral flight_integral_at(double /*time*/) { return {}; }
    static constexpr double pair_weight_at(double /*time*/) { return 0; }

    /// For discs that are both at the place of their collision.
    Separation separation(const DiscState& p, const DiscState& q) const {
        const Shift shift = this->periods_.between(p, q, p.tau);
        return {(q.x - p.x) + shift.x, (q.y - p.y) + shift.y};
    }
    Separation separation_at(const DiscState& p, const DiscState& q, double time) const {
        const Separation stored = Walled::separation_at(p, q, time);
        const Shift shift = this->periods_.between(p, q, time);
        return {stored.x + shift.x, stored.y + shift.y};
    }

    PairContact<double> contact(const DiscState& p, const DiscState& q) const {
        return contact(p, q, this->tolerance());
    }
    PairContact<double> event_contact(const DiscState& p, const DiscState& q) const {
        return contact(p, q, Walled::never);
    }

    /// Nothing in the box is fixed, so no disc has to stop.
    void collide(DiscState& p, DiscState& q, double m, double t) const {
        exchange_momentum(p, q, m + t, Walled::never);
    }
    Loss collide_at(DiscState& p, DiscState& q, double time) const {
        return exchange_momentum(p, q, time, this->since_collision_of(p, q, time));
    }
    /// For rough discs.
    void collide(DiscState& p, DiscState& q, double m, double t, double& p_spin,
                 double& q_spin) const {
        exchange_spin(p, q, m + t, Walled::never, p_spin, q_spin);
    }
    Loss collide_at(DiscState& p, DiscState& q, double time, double& p_spin, double& q_spin) const {
        return exchange_spin(p, q, time, this->since_collision_of(p, q, time), p_spin, q_spin);
    }

    /// The squared speed of the fastest image next to the disc's own one.
    double squared_speed(const DiscState& disc) const {
        const double vx = std::fabs(this->periods_.vx_of(disc)) + std::fabs(this->periods_.speed);
        return vx * vx + disc.vy * disc.vy;
    }
    double squared_speed_at(const DiscState& disc, double time) const {
        DiscState at_home = disc;
        set_image(at_home, this->periods_.home(disc, time));
        return squared_speed(at_home);
    }

private:
    [[gnu::flatten]] PairContact<double> contact(const DiscState& p, const DiscState& q,
                                                 double deepest_overlap) const {
        const double base = std::max(p.tau, q.tau);
        const Shift shift = this->periods_.between(p, q, base);
        const double dx = (q.x_at(base) - p.x_at(base)) + shift.x,
                     dy = (q.y_at(base) - p.y_at(base)) + shift.y;
        return {base, contact_delay(dx, dy, (q.vx - p.vx) + shift.vx, q.vy - p.vy,
                                    this->pair_diameter(p, q), deepest_overlap)};
    }
    /// Advances both discs to where they collide; q is seen as its image.
    Encounter encounter_at(DiscState& p, DiscState& q, double time) const {
        this->advance(p, time);
        this->advance(q, time);
        const Shift shift = this->periods_.between(p, q, time);
        return {(q.x - p.x) + shift.x, (q.y - p.y) + shift.y, (q.vx - p.vx) + shift.vx,
                q.vy - p.vy};
    }
    Loss exchange_momentum(DiscState& p, DiscState& q, double time, double since) const {
        return this->exchange_momentum_at(p, q, encounter_at(p, q, time), since);
    }
    Loss exchange_spin(DiscState& p, DiscState& q, double time, double since, double& p_spin,
                       double& q_spin) const {
        return this->exchange_spin_at(p, q, encounter_at(p, q, time), since, p_spin, q_spin);
    }
};

/// One species or several, any restitution, also 1.
using ShearedMixedDynamics = ShearedDynamics<MixedDynamics>;
using ShearedRoughDynamics = ShearedDynamics<RoughDynamics>;

} // namespace carrom

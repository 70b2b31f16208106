// SPDX-License-Identifier: BSD-3-Clause
// The time integral of stress times area, as sums over events: impulse times distance of collisions
// between discs, and the integral of the sum of m v_a v_b (core/flight_integral.hpp). The pressure
// tensor follows from it (docs/understanding/pressure.md).
//
// Nothing is sampled, so nothing depends on how often sums are read. They are exact, so neither
// the order of collisions nor the rank that carries them out affects them. A pair's collision
// adds to one tensor for both parts, which costs a handful of instructions more than impulse
// times distance alone. The kinetic energy has its own sum; elastic collisions add nothing to it.
#pragma once

#include <array>
#include <cstddef>

#include "core/disc.hpp"
#include "core/exact_sum.hpp"
#include "core/flight_integral.hpp"
#include "dynamics/plain_dynamics.hpp"

namespace carrom {

struct StressSums {
    /// `bound` exceeds each sum; mass times length squared per micro-step, the same on all ranks.
    explicit StressSums(double bound) : xx(bound), xy(bound), yy(bound), energy(bound) {}

    std::array<ExactSum*, 4> parts() { return {&xx, &xy, &yy, &energy}; }
    std::array<const ExactSum*, 4> parts() const { return {&xx, &xy, &yy, &energy}; }

    void clear() {
        for (ExactSum* part : parts()) part->clear();
    }
    StressSums& operator+=(const StressSums& other);
    StressSums& operator-=(const StressSums& other);

    /// Adds `sign` times the integral that a disc of this mass has gathered since the
    /// last sync at its present velocity. A collision that is not one of a pair adds
    /// the integral of the disc before it, and subtracts that of the disc after it.
    void add_flight(double sign, double mass, const Disc& disc, const FlightIntegral& integral);

    ExactSum xx, xy, yy;
    ExactSum energy; ///< the integral of the sum of m v^2
};

/// Terms that wait to be added to sums, because adding many at a time takes a third of the work.
class StressTerms {
public:
    /// Notes that a disc has got the impulse (ix, iy) from another one at the
    /// separation `to`. `add_to` at the latest adds the term to `sum`.
    void add(double ix, double iy, const Separation& to, StressSums& sum) {
        ix_[n_] = ix;
        iy_[n_] = iy;
        x_[n_] = to.x;
        y_[n_] = to.y;
        if (++n_ == most) add_to(sum);
    }
    /// Does what StressSums::add_flight does with the sign 1, but not for the energy.
    void add_flight(double mass, const Disc& disc, const FlightIntegral& integral, StressSums& sum);
    /// Adds the terms that are left, and forgets them.
    void add_to(StressSums& sum);

private:
    static constexpr std::size_t most = 64;

    void add_each(StressSums& sum) const;

    std::array<double, most> ix_{}, iy_{}, x_{}, y_{};
    std::size_t n_ = 0;
};

/// A collision of a pair, noted before it happens. The integral of m v_a v_b changes
/// by the weight of the time times -(i_a u_b + u_a i_b) / 2, where i is the impulse
/// that p gets and u the sum of the relative velocities before and after. This has the
/// form of impulse times distance for another distance, so both parts are one term.
class PairStress {
public:
    PairStress(const Disc& p, const Disc& q)
        : vx_(p.vx), vy_(p.vy), ux_(q.vx - p.vx), uy_(q.vy - p.vy) {}

    /// Called after it, at `time`, with the separation from p to q. Returns p's impulse along x.
    template <class Dynamics>
    [[gnu::always_inline]] double add_to(StressTerms& terms, StressSums& sum,
                                         const Dynamics& dynamics, const Disc& p, const Disc& q,
                                         const Separation& to, double time) const {
        const double mass = dynamics.mass_of(p) * dynamics.slowing_at(time),
                     weight = dynamics.pair_weight_at(time);
        const double ix = mass * (p.vx - vx_), iy = mass * (p.vy - vy_);
        const double ux = ux_ + (q.vx - p.vx), uy = uy_ + (q.vy - p.vy);
        terms.add(ix, iy, {to.x - weight * ux, to.y - weight * uy}, sum);
        if constexpr (!Dynamics::has_elastic_pairs) sum.energy.add(weight * (ix * ux + iy * uy));
        return ix;
    }

private:
    double vx_, vy_, ux_, uy_;
};

} // namespace carrom

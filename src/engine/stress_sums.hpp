// SPDX-License-Identifier: BSD-3-Clause
// The time integral of stress times area, as sums over events: impulse times separation for each
// collision of two discs, and the integral over flights of the sum of m v_a v_b
// (core/flight_integral.hpp). The pressure tensor follows from it (docs/understanding/pressure.md).
//
// Nothing is sampled, so the result does not depend on how often sums are read. Sums are exact, so
// neither the order of collisions nor the rank that carries them out affects them. A collision of a
// pair adds one tensor for both parts, which takes a handful of instructions more than impulse
// times separation alone. The kinetic energy has its own sum, to which elastic collisions add
// nothing. Whole flights take some 60 instructions per disc, so they are added only at some syncs,
// as rarely as the range of the sums allows.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "core/exact_sum.hpp"
#include "core/flight_integral.hpp"
#include "dynamics/encounter.hpp"

namespace carrom {

/// The longest time between two additions of flights to the sums, in micro-steps, unless syncs are
/// further apart.
constexpr std::int64_t longest_flight = 1024;

struct StressSums {
    /// `bound` exceeds each sum; its unit is mass times length squared per micro-step, the same on
    /// all ranks.
    explicit StressSums(double bound) : xx(bound), xy(bound), yy(bound), energy(bound) {}

    std::array<ExactSum*, 4> parts() { return {&xx, &xy, &yy, &energy}; }
    std::array<const ExactSum*, 4> parts() const { return {&xx, &xy, &yy, &energy}; }

    void clear() {
        for (ExactSum* part : parts()) part->clear();
    }
    StressSums& operator+=(const StressSums& other);
    StressSums& operator-=(const StressSums& other);

    /// Adds the integral over the flight of a disc of this mass at its present velocity. It is
    /// called when the disc leaves the box.
    void add_flight(double mass, const DiscState& disc, const FlightIntegral& integral);

    ExactSum xx, xy, yy;
    ExactSum energy; ///< the time integral of the sum of m v^2
};

// Terms are rounded to whole units. After a number of less than 2^51 units is added to
// `unit_shift`, the last bits of the result are the nearest integer to that number. So the bits of
// such results can be added as integers.
constexpr double unit_shift = 0x1.8p52;
constexpr double most_rounded_units = 0x1p51;

CARROM_DEVICE inline std::uint64_t bits_of(double number) {
    return std::bit_cast<std::uint64_t>(number);
}

/// Subtracts a term from a sum, which is an ExactSum or a sum to which a GPU adds.
template <class Sum> CARROM_DEVICE void subtract_rounded(Sum& sum, double term) {
    const double units = term * sum.scale();
    if (std::fabs(units) < most_rounded_units)
        sum.add_units(static_cast<std::int64_t>(bits_of(unit_shift) - bits_of(unit_shift + units)));
    else
        sum.add(-term);
}

/// Adds a collision: a disc gets the impulse (ix, iy) from another one at the separation `to`. The
/// mean of xy and yx is added, because they differ for rough discs.
template <class Sums>
CARROM_DEVICE void add_impulse(Sums& sums, double ix, double iy, const Separation& to) {
    subtract_rounded(sums.xx, ix * to.x);
    subtract_rounded(sums.xy, 0.5 * (ix * to.y + iy * to.x));
    subtract_rounded(sums.yy, iy * to.y);
}

/// Does the same as StressSums::add_flight, without the energy. `terms` are StressTerms or a type
/// with the same functions.
template <class Terms, class Sums>
CARROM_DEVICE void add_flight_to(Terms& terms, Sums& sums, double mass, const DiscState& disc,
                                 const FlightIntegral& integral) {
    const double vx = disc.vx + integral.shift_x, vy = disc.vy + integral.shift_y;
    terms.add(-mass * vx, -mass * vy, {integral.weight * vx, integral.weight * vy}, sums);
    if (integral.rest_x != 0 || integral.rest_y != 0)
        terms.add(-mass * integral.rest_x, -mass * integral.rest_y,
                  {integral.rest_x, integral.rest_y}, sums);
    if (integral.more_y != 0) terms.add(0, -mass * integral.more_y, {0, integral.more_y}, sums);
}

/// Collects terms and adds many of them at once, in a third of the time of adding them one by one.
class StressTerms {
public:
    /// Records a collision: a disc gets the impulse (ix, iy) from another one at the separation
    /// `to`. The term is added to `sum` when the memory for terms is full or `add_to` is called.
    void add(double ix, double iy, const Separation& to, StressSums& sum) {
        ix_[n_] = ix;
        iy_[n_] = iy;
        x_[n_] = to.x;
        y_[n_] = to.y;
        if (++n_ == most) add_to(sum);
    }
    /// Does the same as StressSums::add_flight, without the energy.
    void add_flight(double mass, const DiscState& disc, const FlightIntegral& integral,
                    StressSums& sum) {
        add_flight_to(*this, sum, mass, disc, integral);
    }
    /// Adds the recorded terms that have not been added yet.
    void add_to(StressSums& sum);

private:
    static constexpr std::size_t most = 64;

    void add_each(StressSums& sum) const;

    std::array<double, most> ix_{}, iy_{}, x_{}, y_{};
    std::size_t n_ = 0;
};

/// The stress of a collision of a pair. It is constructed before the collision, which changes the
/// sum of m v_a v_b by -(i_a u_b + u_a i_b) / 2: i is the impulse on p, and u the sum of the
/// relative velocities before and after. Whole flights are added later as if discs had always had
/// their last velocities. So this change times the time flown is subtracted here, in one term with
/// impulse times separation.
template <class Dynamics> class PairStress {
public:
    CARROM_DEVICE PairStress(const DiscState& p, const DiscState& q) : vx_(p.vx), vy_(p.vy) {
        if constexpr (Dynamics::has_species) wx_ = q.vx - p.vx, wy_ = q.vy - p.vy;
    }

    double vx() const { return vx_; } ///< velocity of p before the collision
    double vy() const { return vy_; }

    /// Called after the collision at `time`, with the separation from p to q. `flown`: time of
    /// flights before the last sync that the sums still lack. Returns p's impulse along x.
    template <class Terms, class Sums>
    [[gnu::always_inline]] CARROM_DEVICE double add_to(Terms& terms, Sums& sum,
                                                       const Dynamics& dynamics, const DiscState& p,
                                                       const DiscState& q, const Separation& to,
                                                       double time, double flown) const {
        const double gained_x = p.vx - vx_, gained_y = p.vy - vy_;
        // With equal masses q loses what p gains, so the velocities after the collision give u / 2.
        double half_ux = (q.vx - p.vx) + gained_x, half_uy = (q.vy - p.vy) + gained_y;
        if constexpr (Dynamics::has_species) {
            half_ux = 0.5 * (wx_ + (q.vx - p.vx));
            half_uy = 0.5 * (wy_ + (q.vy - p.vy));
        }
        const double mass = dynamics.mass_of(p) * dynamics.slowing_at(time),
                     weight = dynamics.pair_weight_at(time) + flown, twice = weight + weight;
        const double ix = mass * gained_x, iy = mass * gained_y;
        terms.add(ix, iy, {to.x - twice * half_ux, to.y - twice * half_uy}, sum);
        if (!dynamics.has_elastic_pairs()) sum.energy.add(twice * (ix * half_ux + iy * half_uy));
        return ix;
    }

private:
    struct Nothing {};
    using Relative = std::conditional_t<Dynamics::has_species, double, Nothing>;

    double vx_, vy_;
    [[no_unique_address]] Relative wx_, wy_; ///< relative velocity before the collision
};

/// Changes the integral over flights by a collision of one disc with a wall or a fixed body, which
/// counts as a second disc at rest. It is constructed before the collision.
template <class Dynamics> class WallStress {
public:
    CARROM_DEVICE explicit WallStress(const DiscState& disc) : vx_(disc.vx), vy_(disc.vy) {}

    /// Called after the collision, like PairStress::add_to.
    template <class Terms, class Sums>
    [[gnu::always_inline]] CARROM_DEVICE void add_to(Terms& terms, Sums& sum,
                                                     const Dynamics& dynamics,
                                                     const DiscState& disc, double time,
                                                     double flown) const {
        FlightIntegral integral = dynamics.flight_integral_at(time);
        integral.weight += flown;
        const double mass = dynamics.mass_of(disc);
        if constexpr (Dynamics::may_lose_discs) {
            if (disc.has_departed()) {
                DiscState before = disc;
                before.vx = vx_, before.vy = vy_;
                return sum.add_flight(mass, before, integral);
            }
        }
        const double ix = mass * (disc.vx - vx_), iy = mass * (disc.vy - vy_);
        const double ux = integral.weight * (disc.vx + vx_ + 2 * integral.shift_x),
                     uy = integral.weight * (disc.vy + vy_ + 2 * integral.shift_y);
        terms.add(ix, iy, {ux, uy}, sum);
        const double lost = -(ix * ux + iy * uy);
        if (lost != 0) sum.energy.add(lost); // an elastic wall at rest takes no energy
    }

private:
    double vx_, vy_;
};

} // namespace carrom

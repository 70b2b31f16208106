// SPDX-License-Identifier: BSD-3-Clause
// Less accurate arithmetic, for the accuracy study (docs/understanding/accuracy.md): single
// precision, the naive contact formula, or both. It replaces StableArithmetic in the plain dynamics
// if the scene selects it.
//
// `Number` is the precision of states and of computation. A state of floats is stored as doubles of
// the same values, so the rest of the program does not depend on the precision. The formula is
// chosen when the program runs.
//
// Such arithmetic finds contacts where discs do not touch, and misses others. The search covers the
// pairs that can touch, and other pairs within a margin that depends on ranks and threads. So that
// contacts do not depend on these, a contact counts only if the centres are within a fixed distance
// (`farthest_`).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "dynamics/arithmetic.hpp"
#include "dynamics/naive_contact.hpp"

namespace carrom {

/// The state of a disc in the precision of the computation.
template <class Real> struct RoundedState {
    Real x, y, vx, vy, tau;

    CARROM_DEVICE explicit RoundedState(const DiscState& disc)
        : x(static_cast<Real>(disc.x)), y(static_cast<Real>(disc.y)),
          vx(static_cast<Real>(disc.vx)), vy(static_cast<Real>(disc.vy)),
          tau(static_cast<Real>(disc.tau)) {}
    CARROM_DEVICE Real x_at(Real time) const { return x + vx * (time - tau); }
    CARROM_DEVICE Real y_at(Real time) const { return y + vy * (time - tau); }
};

template <class Number> class StudiedArithmetic {
    static constexpr bool is_single = std::is_same_v<Number, float>;

public:
    using Real = Number;
    using State = RoundedState<Number>;
    static constexpr bool is_for_study = true;
    /// If discs have no room to move, rounding sometimes advances their times, so a collision
    /// cascade extends over a range of times.
    static constexpr double cascade_interval = 0x1p-3;
    static constexpr double time_rounding = is_single ? 0x1p-21 : 0x1p-50;

    StudiedArithmetic(const Box& box, double radius, ContactFormula formula)
        : formula_(formula), place_rounding_(is_single ? 0x1p-18 * rounded(box).longest() : 0),
          slack_(place_rounding_ + (formula == ContactFormula::stable
                                        ? 0
                                        : misplacement(box, radius) * rounded(radius))),
          farthest_(2 * rounded(radius) + 2 * slack_ - place_rounding_) {}

    static double rounded(double number) { return static_cast<Real>(number); }
    static Box rounded(const Box& box) { return {rounded(box.x), rounded(box.y)}; }
    /// Rounds the numbers of a state to the precision `Number`.
    static void round(DiscState& disc) {
        for (double* number : {&disc.x, &disc.y, &disc.vx, &disc.vy, &disc.tau})
            *number = rounded(*number);
    }
    static double tolerance(const Box& box, double diameter) {
        return std::max(static_cast<Real>(1e-12) * static_cast<Real>(diameter),
                        16 * std::numeric_limits<Real>::epsilon() *
                            static_cast<Real>(box.longest()));
    }
    CARROM_DEVICE double slack() const { return slack_; }
    CARROM_DEVICE double place_rounding() const { return place_rounding_; }
    bool parts_overlaps() const { return formula_ == ContactFormula::stable; }

    CARROM_DEVICE static void advance(DiscState& disc, double time) {
        const State flight(disc);
        disc.x = flight.x_at(static_cast<Real>(time));
        disc.y = flight.y_at(static_cast<Real>(time));
        disc.tau = static_cast<Real>(time);
    }
    CARROM_DEVICE Real delay(const Encounter<Real>& met, Real sigma, Real deepest_overlap) const {
        if (formula_ == ContactFormula::stable)
            return contact_delay(met.ex, met.ey, met.wx, met.wy, sigma, deepest_overlap);
        return naive_contact_delay(met.ex, met.ey, met.wx, met.wy, sigma,
                                   formula_ == ContactFormula::naive_contracted);
    }
    /// Whether the centres of the discs, advanced to the contact's time in double precision, are at
    /// most `farthest_` apart.
    CARROM_DEVICE bool counts(const DiscState& p, const DiscState& q,
                              const PairContact<Real>& found) const {
        const double time = static_cast<double>(found.base) + static_cast<double>(found.delay);
        const double dx = q.x_at(time) - p.x_at(time), dy = q.y_at(time) - p.y_at(time);
        return dx * dx + dy * dy <= farthest_ * farthest_;
    }

private:
    /// The largest error, in diameters, of the distance at a contact found by a formula with
    /// cancellation. For discs d diameters apart, a rounding error u changes B^2 - 4 A C by about u
    /// (2 d v)^2. Thus a grazing contact moves along the flight by s diameters, the square root of
    /// this change over 2 v, and the distance changes by about s^2. Contacts with errors above half
    /// a diameter count as lost.
    static double misplacement(const Box& box, double radius) {
        const double longest = std::numbers::sqrt2 * rounded(box).longest() / (2 * rounded(radius));
        return std::min(0.5, 2.5 * std::numeric_limits<Real>::epsilon() * longest * longest);
    }

    ContactFormula formula_;
    double place_rounding_, slack_;
    double farthest_; ///< the largest distance between centres at which a contact counts
};

} // namespace carrom

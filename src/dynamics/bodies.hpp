// SPDX-License-Identifier: BSD-3-Clause
// The bodies of a dynamics (dynamics.hpp) give the radius and the mass of each disc and the rate at
// which radii grow. They are plain data.
//
//   EqualBodies     all discs have the same radius, and mass 1
//   SpeciesBodies   each species has a radius and a mass (species.hpp)
//   GrowingBodies   one species or several; radii grow at a constant rate, r(t) = r(0)
//                   (1 + rate t), as in the method of Lubachevsky and Stillinger (J. Stat.
//                   Phys. 60, 561 (1990)); event-driven method only. Radii follow from the time
//                   since the scene's start, so states do not contain them. The law of collisions
//                   is applied to the velocities of the touching surfaces. If the rate is 0, an
//                   effect may multiply all radii by the same factor at syncs (sync_effect.hpp).
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "dynamics/arithmetic.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/encounter.hpp"
#include "dynamics/growing_contact.hpp"
#include "dynamics/species.hpp"

namespace carrom {

/// The properties of a disc at a given time that a collision with a side of the box depends on.
struct Body {
    double radius = 0, mass = 1;
    double outwards = 0; ///< speed at which the surface moves outwards
};

template <class B>
concept Bodies = std::is_trivially_copyable_v<B> &&
                 requires(B changing, const B bodies, const DiscState& p, std::int64_t n,
                          double time, const Encounter<double>& met, StableArithmetic by,
                          SpeciesView species) {
                     {
                         B::have_species
                     } -> std::convertible_to<bool>; // radii and masses may differ
                     { B::grow } -> std::convertible_to<bool>;
                     // If discs collide thousands of times within this many micro-steps, the run
                     // ends as a collision cascade.
                     { B::cascade_interval } -> std::convertible_to<double>;
                     changing.begin_interval(n);   // times are then relative to micro-step n
                     changing.look_up_in(species); // uses the radii and masses of this table
                     {
                         bodies.largest()
                     } -> std::same_as<double>; // the largest radius at the scene's start
                     { bodies.of(p) } -> std::convertible_to<SizeAndMass>;
                     { bodies.at(p, time) } -> std::same_as<Body>;
                     // the factor by which radii have grown since the scene's start
                     { bodies.size_at(time) } -> std::convertible_to<double>;
                     // time from `time` until the discs touch (pair_contact.hpp)
                     { bodies.delay(by, p, p, met, time, time) } -> std::same_as<double>;
                     // `met`, but with the relative velocity of the touching surfaces
                     { bodies.surfaces(met, time) } -> std::same_as<Encounter<double>>;
                 };

class EqualBodies {
public:
    static constexpr bool have_species = false, grow = false;
    static constexpr double cascade_interval = 0x1p-40;

    EqualBodies(double radius, const Effects& /*effects*/, SpeciesView /*species*/)
        : radius_(radius), diameter_(2 * radius) {}

    CARROM_DEVICE static void begin_interval(std::int64_t /*n*/) {}
    static void look_up_in(SpeciesView /*species*/) {}
    CARROM_DEVICE double largest() const { return radius_; }
    CARROM_DEVICE SizeAndMass of(const DiscState& /*disc*/) const { return {radius_, 1}; }
    CARROM_DEVICE Body at(const DiscState& /*disc*/, double /*time*/) const {
        return {radius_, 1, 0};
    }
    CARROM_DEVICE static constexpr double size_at(double /*time*/) { return 1; }
    template <class Arithmetic, class State, class Real>
    [[gnu::always_inline]] CARROM_DEVICE Real delay(const Arithmetic& arithmetic,
                                                    const State& /*p*/, const State& /*q*/,
                                                    const Encounter<Real>& met, Real /*time*/,
                                                    Real deepest_overlap) const {
        return arithmetic.delay(met, static_cast<Real>(diameter_), deepest_overlap);
    }
    template <class Real>
    CARROM_DEVICE static Encounter<Real> surfaces(const Encounter<Real>& met, Real /*time*/) {
        return met;
    }

private:
    double radius_, diameter_;
};

class SpeciesBodies {
public:
    static constexpr bool have_species = true, grow = false;
    static constexpr double cascade_interval = 0x1p-40;

    /// `radius` is the largest radius of all species.
    SpeciesBodies(double radius, const Effects& /*effects*/, SpeciesView species)
        : radius_(radius), species_(species) {}

    CARROM_DEVICE static void begin_interval(std::int64_t /*n*/) {}
    void look_up_in(SpeciesView species) { species_ = species; }
    CARROM_DEVICE double largest() const { return radius_; }
    CARROM_DEVICE const SizeAndMass& of(const DiscState& disc) const {
        return species_.of(disc.id);
    }
    CARROM_DEVICE Body at(const DiscState& disc, double /*time*/) const {
        const SizeAndMass& it = species_.of(disc.id);
        return {it.radius, it.mass, 0};
    }
    CARROM_DEVICE static constexpr double size_at(double /*time*/) { return 1; }
    /// The sum of the two radii has the same bits in either order of the discs.
    [[gnu::always_inline]] CARROM_DEVICE double delay(const StableArithmetic& arithmetic,
                                                      const DiscState& p, const DiscState& q,
                                                      const Encounter<double>& met, double /*time*/,
                                                      double deepest_overlap) const {
        return arithmetic.delay(met, of(p).radius + of(q).radius, deepest_overlap);
    }
    CARROM_DEVICE static Encounter<double> surfaces(const Encounter<double>& met, double /*time*/) {
        return met;
    }

private:
    double radius_;
    SpeciesView species_;
};

class GrowingBodies {
public:
    static constexpr bool have_species = true, grow = true;
    /// Growing discs that jam collide more and more often. This interval is long, so that the run
    /// ends before that takes hours.
    static constexpr double cascade_interval = 0x1p-10;

    /// `effects` have times in micro-steps.
    GrowingBodies(double radius, const Effects& effects, SpeciesView species)
        : radius_(radius), rate_(effects.growth), species_(species) {}

    CARROM_DEVICE void begin_interval(std::int64_t n) {
        at_sync_ = size_ * (1 + rate_ * static_cast<double>(n));
    }
    /// Sets all radii to the scene's radii times `size`. Only for a growth rate of 0, so that radii
    /// change only at syncs.
    void resize(double size) { at_sync_ = size_ = size; }
    void look_up_in(SpeciesView species) { species_ = species; }
    CARROM_DEVICE double largest() const { return radius_; }
    CARROM_DEVICE const SizeAndMass& of(const DiscState& disc) const {
        return species_.of(disc.id);
    }
    CARROM_DEVICE Body at(const DiscState& disc, double time) const {
        const SizeAndMass& it = species_.of(disc.id);
        return {it.radius * size_at(time), it.mass, it.radius * rate_};
    }
    CARROM_DEVICE double size_at(double time) const { return at_sync_ + rate_ * time; }
    [[gnu::always_inline]] CARROM_DEVICE double delay(const StableArithmetic& /*arithmetic*/,
                                                      const DiscState& p, const DiscState& q,
                                                      const Encounter<double>& met, double time,
                                                      double deepest_overlap) const {
        const double size = size_at(time);
        return growing_contact_delay(met.ex, met.ey, met.wx, met.wy,
                                     (of(p).radius + of(q).radius) * size, rate_ / size,
                                     deepest_overlap);
    }
    CARROM_DEVICE Encounter<double> surfaces(const Encounter<double>& met, double time) const {
        const double rate = rate_ / size_at(time);
        return {met.ex, met.ey, std::fma(-rate, met.ex, met.wx), std::fma(-rate, met.ey, met.wy)};
    }

private:
    double radius_, rate_;
    SpeciesView species_;
    double at_sync_ = 1; ///< factor by which radii had grown from the start to the last sync
    double size_ = 1;    ///< the part of this factor that an effect has set at a sync
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// How discs fly, collide with each other and meet walls at rest: a space, bodies, a law and an
// arithmetic, with the functions that use them. It is the part of a dynamics (dynamics.hpp) that is
// plain data, so kernels of a GPU get a copy of it and run the same functions.
#pragma once

#include <algorithm>
#include <type_traits>

#include "core/axis.hpp"
#include "core/device.hpp"
#include "dynamics/bodies.hpp"
#include "dynamics/law.hpp"
#include "dynamics/resting_walls.hpp"
#include "dynamics/space.hpp"

namespace carrom {

template <Space InSpace, Bodies OfBodies, class InSurroundings> class Motion {
public:
    using Surroundings = InSurroundings;
    using Arithmetic = typename Surroundings::Arithmetic;
    using Real = typename Arithmetic::Real;

    // What can happen in a scene. Kernels contain no code for events that cannot happen.
    static constexpr bool have_effects = Surroundings::have_effects,
                          is_periodic = InSpace::is_periodic,
                          has_moving_images = InSpace::has_moving_images,
                          has_species = OfBodies::have_species,
                          // Whether discs can leave through open sides
        may_lose_discs = have_effects && !is_periodic, is_for_study = Arithmetic::is_for_study;

    /// `effects` have times in micro-steps; `radius` is the largest radius of the discs of these
    /// `species`. `species` and `pairs` refer to tables that another object owns.
    Motion(const Box& box, double radius, const Effects& effects, ContactFormula formula,
           SpeciesView species, const PairView& pairs)
        : arithmetic_(box, radius, formula), box_(Arithmetic::rounded(box)),
          radius_(Arithmetic::rounded(radius)),
          band_(static_cast<Real>(1e-8) * static_cast<Real>(radius)),
          tolerance_(Arithmetic::tolerance(box_, 2 * radius_)), space_(box_, effects),
          bodies_(radius_, effects, species), law_(effects, radius_, pairs) {}

    /// From now on radii and masses are read from the table of `species`.
    void look_up_species_in(SpeciesView species) { bodies_.look_up_in(species); }

    // Properties of the scene.

    CARROM_DEVICE bool has_pairs() const { return !have_effects || law_.has_pairs(); }
    CARROM_DEVICE bool has_spin() const { return have_effects && law_.has_spin(); }
    /// Whether collisions of pairs conserve the kinetic energy.
    CARROM_DEVICE bool has_elastic_pairs() const {
        return !have_effects || (law_.is_elastic() && !OfBodies::grow);
    }
    bool parts_overlaps() const { return arithmetic_.parts_overlaps(); }

    // Sizes of discs before they grow; the radius is the largest radius of all discs.

    CARROM_DEVICE const Box& box() const { return box_; }
    CARROM_DEVICE double radius() const { return radius_; }
    CARROM_DEVICE double diameter() const { return 2 * radius_; }
    CARROM_DEVICE double tolerance() const { return tolerance_; }
    /// Half the largest gap that rounding leaves between two discs at a contact. Searches enlarge
    /// each radius by this length.
    CARROM_DEVICE double slack() const { return space_.slack() + arithmetic_.slack(); }
    /// The largest distance between the centres of two discs at a contact.
    CARROM_DEVICE double search_diameter() const { return diameter() + 2 * slack(); }
    double size_at(double time) const { return bodies_.size_at(time); }
    CARROM_DEVICE double mass_of(const DiscState& disc) const { return bodies_.of(disc).mass; }

    // Squared speeds from which searches derive how far a disc can fly: squared_speed is that of
    // the stored image of a disc, squared_speed_at that of its image in the box at `time`. Under
    // shear both are upper bounds, which also hold for the images in the adjacent rows of boxes.

    CARROM_DEVICE double squared_speed(const DiscState& disc) const {
        return space_.squared_speed(disc);
    }
    double squared_speed_at(const DiscState& disc, double time) const {
        return space_.squared_speed_at(disc, time);
    }
    CARROM_DEVICE const Periods& periods() const
        requires is_periodic
    {
        return space_.periods();
    }
    /// Changes the side lengths of a box that is periodic along both axes.
    void reshape(const Box& box)
        requires(is_periodic && !has_moving_images)
    {
        box_ = box;
        tolerance_ = Arithmetic::tolerance(box_, 2 * radius_);
        space_.reshape(box);
    }
    /// Brings a state that a sync has just advanced back into the box.
    CARROM_DEVICE void wrap(DiscState& disc) const
        requires is_periodic
    {
        space_.wrap(disc);
    }

    CARROM_DEVICE static void advance(DiscState& disc, double time) {
        Arithmetic::advance(disc, time);
    }
    static void round(DiscState& disc)
        requires is_for_study
    {
        Arithmetic::round(disc);
    }

    // Pairs.

    /// The contact of two discs in free flight (pair_contact.hpp). Discs that overlap by more than
    /// `deepest_overlap` have no contact.
    [[gnu::always_inline]] CARROM_DEVICE PairContact<Real> contact(const DiscState& p,
                                                                   const DiscState& q,
                                                                   double deepest_overlap) const {
        if (may_lose_discs && (p.has_departed() || q.has_departed())) return {};
        const typename Arithmetic::State a(p), b(q);
        const Real base = std::max(a.tau, b.tau);
        const Encounter<Real> met = space_.see(a, b, b.x_at(base) - a.x_at(base),
                                               b.y_at(base) - a.y_at(base), base);
        const PairContact<Real> found{
            base, bodies_.delay(arithmetic_, a, b, met, base, static_cast<Real>(deepest_overlap))};
        return arithmetic_.counts(p, q, found) ? found : PairContact<Real>{};
    }
    /// Carries out the collision at `time`. `p` has the lower id, and `since` is the time since the
    /// last collision of either disc.
    [[gnu::always_inline]] CARROM_DEVICE Loss collide(DiscState& p, DiscState& q, double time,
                                                      double since, const Spins& spins = {}) const {
        advance(p, time);
        advance(q, time);
        const typename Arithmetic::State a(p), b(q);
        const auto at = static_cast<Real>(time);
        const Encounter<Real> met = space_.see(a, b, b.x - a.x, b.y - a.y, at);
        const Loss loss = law_.meet(p, q, bodies_.surfaces(met, at), bodies_.of(p), bodies_.of(q),
                                    since, spins);
        if (have_effects) p.has_collided = q.has_collided = 1;
        return loss;
    }
    CARROM_DEVICE static double since_collision_of(const DiscState& p, const DiscState& q,
                                                   double time) {
        return std::min(since_collision(p, time), since_collision(q, time));
    }
    /// The separation from p to q; both states are at the time of their collision.
    Separation separation(const DiscState& p, const DiscState& q) const {
        const Encounter<double> met = space_.see(p, q, q.x - p.x, q.y - p.y, p.tau);
        return {met.ex, met.ey};
    }
    /// The separation from p to q at `time`; their states are at this time or earlier.
    CARROM_DEVICE Separation separation_at(const DiscState& p, const DiscState& q,
                                           double time) const {
        const Encounter<double> met = space_.see(p, q, q.x_at(time) - p.x_at(time),
                                                 q.y_at(time) - p.y_at(time), time);
        return {met.ex, met.ey};
    }

    // Walls at rest, as the time-stepped method treats them.

    CARROM_DEVICE bool is_periodic_along(Axis axis) const { return space_.is_periodic_along(axis); }
    CARROM_DEVICE RestingWalls<Real> resting_walls(Axis axis, const DiscState& disc) const {
        return {static_cast<Real>(along(axis, box_)), static_cast<Real>(bodies_.of(disc).radius),
                static_cast<Real>(band_)};
    }
    CARROM_DEVICE Body body_of(const DiscState& disc) const { return bodies_.at(disc, disc.tau); }

protected:
    Arithmetic arithmetic_;
    Box box_;
    double radius_, band_, tolerance_;
    InSpace space_;
    OfBodies bodies_;
    Law law_;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Sums over all discs that come out the same for every machine shape: integers and 128-bit fixed
// point.
#pragma once

#include <span>

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"
#include "core/disc.hpp"
#include "dynamics/effects.hpp"
#include "engine/stored_state.hpp"
#include "engine/totals.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Fills in the collision counts and the state hash; `columns` run along the discs.
/// **Collective.**
void measure_collisions(std::span<const Disc> own, const SideSpans& columns,
                        const Communicator& communicator, Totals& totals);

/// Fills in how many discs have left through which side. **Collective.**
void measure_departures(std::span<const Disc> own, const Box& box, const Communicator& communicator,
                        Totals& totals);

/// Fills in energy and momentum; `velocity_unit` turns stored velocities into those per step.
/// `species_table`: null for masses of 1. **Collective.**
void measure_motion(std::span<const Disc> own, const SpeciesTable* species_table,
                    double velocity_unit, const Communicator& communicator, Totals& totals);

/// The discs themselves, or where `effects` open sides those whose centres are in the box at
/// `time`, copied to `kept`.
std::span<const Disc> discs_in_box(std::span<const Disc> discs, const Effects& effects,
                                   const Extent& box, double time, std::vector<Disc>& kept);

/// Fills in the energy of spins; moments of inertia are `inertia` m r^2. **Collective.**
void measure_rotation(std::span<const Disc> own, std::span<const double> spins,
                      const SpeciesTable& species_table, double inertia, double velocity_unit,
                      const Communicator& communicator, Totals& totals);

/// Fills in the potential energy of discs as the box sees them. **Collective.**
void measure_height(std::span<const Disc> own, const SpeciesTable* species_table,
                    const Gravity& gravity, const Box& box, const Communicator& communicator,
                    Totals& totals);

/// When two discs count as overlapping: closer than the diameter by more than the tolerance.
struct Touching {
    double diameter = 0, tolerance = 0;
    const SpeciesTable* species_table = nullptr; ///< null where all diameters are equal
    double growth = 1;                           ///< of the table's radii

    double diameter_of(const Disc& p, const Disc& q) const {
        return species_table
                   ? growth * (species_table->of(p.id).radius + species_table->of(q.id).radius)
                   : diameter;
    }
    Periods periods = {}; ///< of the discs' images
};
template <class Dynamics>
Touching touching_of(const Dynamics& dynamics, double time, const Periods& periods) {
    const double growth = dynamics.growth_at(time), diameter = growth * dynamics.diameter();
    if constexpr (Dynamics::has_species)
        return {diameter, dynamics.tolerance(), &dynamics.species_table(), growth, periods};
    else
        return {diameter, dynamics.tolerance(), nullptr, growth, periods};
}

/// Fills in the pairs that overlap at `time`, each counted once, how far the deepest overlaps, the
/// pairs that touch, and how many discs touch several. Pairs that touch slide along each other
/// where (d.w)^2 <= 4 tolerance sigma w.w, with d and w their separation and relative velocity.
/// Their distance of closest approach is a diameter then, to within the tolerance. The grid holds
/// the population at that time, for partners within a diameter and the tolerance. **Collective.**
void measure_overlaps(const Population& population, const CellGrid& grid, double time,
                      const Touching& touching, const Communicator& communicator, int n_threads,
                      Totals& totals);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Sums over all discs whose bits do not depend on the numbers of ranks and threads: integers and
// 128-bit fixed point.
#pragma once

#include <span>

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"
#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"
#include "engine/stored_state.hpp"
#include "engine/totals.hpp"
#include "parallel/communicator.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

/// Fills in the collision counts and the state hash; side `columns` are in the order of the discs.
/// **Collective.**
void measure_collisions(std::span<const DiscState> own, const SideSpans& columns,
                        const Communicator& communicator, int n_threads, Totals& totals);

/// Fills in how many discs have left through each side. **Collective.**
void measure_departures(std::span<const DiscState> own, const Box& box,
                        const Communicator& communicator, Totals& totals);

/// Fills in energy and momentum. `velocity_unit` converts stored velocities to velocities per step.
/// `species_table` is null if all masses are 1. **Collective.**
void measure_motion(std::span<const DiscState> own, const SpeciesTable* species_table,
                    double velocity_unit, const Communicator& communicator, int n_threads,
                    Totals& totals);

/// Returns `discs` or, if a side is open in `effects`, only the discs whose centres are in the box
/// at `time`, copied to `kept`.
std::span<const DiscState> discs_in_box(std::span<const DiscState> discs, const Effects& effects,
                                        const Extent& box, double time, DiscStates& kept);

/// The data, besides the discs, from which energies are computed.
struct EnergySetting {
    const Effects& effects;
    const Box& box;
    double velocity_unit = 1; ///< converts stored velocities to velocities per step
    double sync_interval = 0; ///< time between syncs, in micro-steps
};

/// Adds the energies of the kinds in `energies`, summed over all ranks, to the totals. `shown` are
/// the own discs in the box's own frame; `spins` are in the same order, or empty. **Collective.**
void measure_other_energies(std::span<const OtherEnergy> energies, std::span<const DiscState> shown,
                            std::span<const double> spins, const SpeciesTable& species_table,
                            const EnergySetting& setting, const Communicator& communicator,
                            Totals& totals);

/// Two discs overlap if the diameter exceeds their distance by more than the tolerance. They touch
/// if the two lengths differ by at most the tolerance.
struct Touching {
    double diameter = 0, tolerance = 0;
    const SpeciesTable* species_table = nullptr; ///< null if all diameters are equal
    double size = 1;                             ///< factor by which the table's radii have changed

    double diameter_of(const DiscState& p, const DiscState& q) const {
        return species_table
                   ? size * (species_table->of(p.id).radius + species_table->of(q.id).radius)
                   : diameter;
    }
    Periods periods = {}; ///< periods by which images of discs are displaced
};
template <class Dynamics>
Touching touching_of(const Dynamics& dynamics, double time, const Periods& periods) {
    const double size = dynamics.size_at(time), diameter = size * dynamics.diameter();
    if constexpr (Dynamics::has_species)
        return {diameter, dynamics.tolerance(), &dynamics.species_table(), size, periods};
    else
        return {diameter, dynamics.tolerance(), nullptr, size, periods};
}

/// Fills in the number of pairs that overlap at `time`, the deepest overlap, the numbers of pairs
/// that touch and that slide, and the number of discs that touch several others. A touching pair
/// slides if (d.w)^2 <= 4 tolerance sigma w.w, with separation d, relative velocity w and diameter
/// sigma: the closest approach is then a diameter, to within a few tolerances. The grid must be
/// sorted at `time` and reach at least a diameter plus the tolerance. **Collective.**
void measure_overlaps(const Population& population, const CellGrid& grid, double time,
                      const Touching& touching, const Communicator& communicator, int n_threads,
                      Totals& totals);

/// The largest factor for all radii of the scene at which no two discs of the population overlap at
/// time 0, reduced by a relative amount of 2^-40 for rounding. Pairs beyond the grid's reach are
/// ignored. If there are no pairs, the factor is infinite. **Collective.**
double largest_size(const Population& population, const CellGrid& grid, const Touching& touching,
                    const Communicator& communicator, int n_threads);

} // namespace carrom

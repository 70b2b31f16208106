// SPDX-License-Identifier: BSD-3-Clause
// Sums over all discs that come out the same for every machine shape: integers and 128-bit fixed point.
#pragma once

#include <span>

#include "carrom/collision/cell_grid.hpp"
#include "carrom/collision/search.hpp"
#include "carrom/core/disc.hpp"
#include "carrom/parallel/communicator.hpp"
#include "carrom/simulation/simulation.hpp"

namespace carrom {

/// Fills in the collision counts and the state hash. **Collective.**
void measure_collisions(std::span<const Disc> own, const Communicator& communicator, Totals& totals);

/// Fills in energy and momentum; `velocity_unit` turns stored velocities into those per step. **Collective.**
void measure_motion(std::span<const Disc> own, double velocity_unit, const Communicator& communicator, Totals& totals);

/// Fills in the potential energy of discs as the box sees them. **Collective.**
void measure_height(std::span<const Disc> own, const Gravity& gravity, double box_size, const Communicator& communicator, Totals& totals);

/// When two discs count as overlapping: closer than the diameter by more than the tolerance.
struct Touching {
    double diameter = 0, tolerance = 0;
};

/// Fills in the pairs that overlap at `time`, each counted once, and how far the deepest overlaps. The grid holds the
/// population at that time, and partners within a diameter are within its reach. **Collective.**
void measure_overlaps(const Population& population, const CellGrid& grid, double time, const Touching& touching,
                      const Communicator& communicator, int n_threads, Totals& totals);

} // namespace carrom

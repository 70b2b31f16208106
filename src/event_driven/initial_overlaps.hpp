// SPDX-License-Identifier: BSD-3-Clause
// Ends a run that would start from overlapping discs. The event-driven method cannot handle them,
// because there is no time at which such discs collided.
#pragma once

#include <string>

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"
#include "engine/state_sums.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Throws InputError on every rank if discs overlap at `time` by more than twice the tolerance. The
/// error names the first few pairs and the number of all pairs. The grid must contain the
/// population at that time, and its reach must be at least the largest diameter. **Collective.**
void refuse_overlaps(const Population& population, const CellGrid& grid, double time,
                     const Touching& touching, const Communicator& communicator, int n_threads,
                     const std::string& scene_name);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// How far the sides of a periodic box can change at a constant area until two discs touch.
#pragma once

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"
#include "dynamics/sync_effect.hpp"
#include "engine/state_sums.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// The factors for the side along x at which no two discs are closer than their diameter plus
/// `margin`. If positions are multiplied by t along x and divided by t along y, two discs at (dx,
/// dy) have the squared distance t^2 dx^2 + dy^2 / t^2. The range ends where that is the squared
/// diameter, at roots of a quadratic equation in t^2, and it contains 1. States are at time 0, and
/// the grid contains all pairs that can touch within the stretches that the caller needs.
/// **Collective.**
StretchRange stretch_room(const Population& population, const CellGrid& grid,
                          const Touching& touching, double margin, const Communicator& communicator,
                          int n_threads);

} // namespace carrom

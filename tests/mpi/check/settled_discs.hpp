// SPDX-License-Identifier: BSD-3-Clause
// What a self-check sees, as plain data that a test may spoil.
#pragma once

#include <vector>

#include "carrom/collision/cell_grid.hpp"
#include "carrom/domain/strips.hpp"
#include "engine.hpp"

namespace carrom::test {

struct SettledDiscs {
    std::vector<Disc> discs; ///< own ones first
    std::size_t n_own = 0;
    CellGrid grid;
    Strips strips;
    double time = 0;
    Frame frame;

    Settled view() const { return {{discs, n_own}, &grid, &strips, time, frame}; }
    /// Puts the discs into the cells they are in now, the own ones into their order; partners within a diameter are within reach.
    void sort_into_cells(double box_size, double radius);
};

/// A copy of what an engine has settled.
SettledDiscs copy_of(const Settled& settled);

/// All of the few `discs`, those in this rank's equal strip as its own, the others as its halo.
SettledDiscs settled_by_hand(const std::vector<Disc>& discs, double time, double box_size, double radius, int rank, int n_ranks);

} // namespace carrom::test

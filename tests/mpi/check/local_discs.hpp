// SPDX-License-Identifier: BSD-3-Clause
// What a self-check sees, as plain data that a test may spoil.
#pragma once

#include <vector>

#include "cell_list/cell_grid.hpp"
#include "domain/domains.hpp"
#include "engine/engine.hpp"

namespace carrom::test {

struct LocalDiscs {
    std::vector<DiscState> discs; ///< own ones first
    std::size_t n_own = 0;
    CellGrid grid;
    Domains domains;
    double time = 0;
    Frame frame;

    LocalView view() const { return {{discs, n_own}, &grid, &domains, time, frame}; }
    /// Puts the discs into the cells they are in now, the own ones into their order; partners
    /// within a diameter are within reach.
    void sort_into_cells(double box_size, double radius);
};

/// A copy of what an engine has settled.
LocalDiscs copy_of(const LocalView& local_view);

/// All of the few `discs`, those in this rank's equal strip as its own, the others as its halo.
LocalDiscs view_by_hand(const std::vector<DiscState>& discs, double time, double box_size,
                        double radius, int rank, int n_ranks);

} // namespace carrom::test

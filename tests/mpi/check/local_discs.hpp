// SPDX-License-Identifier: BSD-3-Clause
// The data that a self-check gets, as plain structs that a test may change.
#pragma once

#include <vector>

#include "cell_list/cell_grid.hpp"
#include "domain/domains.hpp"
#include "engine/engine.hpp"

namespace carrom::test {

struct LocalDiscs {
    std::vector<DiscState> discs; ///< own discs first
    std::size_t n_own = 0;
    CellGrid grid;
    Domains domains;
    double time = 0;
    Frame frame;

    LocalView view() const { return {{discs, n_own}, &grid, &domains, time, frame}; }
    /// Puts discs into the cells of their present positions, and own discs into the order of cells.
    /// Partners within a diameter are within reach.
    void sort_into_cells(double box_size, double radius);
};

/// A copy of a view that an engine has redistributed.
LocalDiscs copy_of(const LocalView& local_view);

/// A view of a few `discs`: those in this rank's strip (of equal strips) are own discs, the other
/// discs are the halo.
LocalDiscs view_by_hand(const std::vector<DiscState>& discs, double time, double box_size,
                        double radius, int rank, int n_ranks);

} // namespace carrom::test

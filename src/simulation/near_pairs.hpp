// SPDX-License-Identifier: BSD-3-Clause
// The pairs of discs that a grid has near each other, each once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "carrom/collision/cell_grid.hpp"

namespace carrom {

/// Those of them that one of the columns has: the others' columns are no lower.
template <class Visit> void visit_near_pairs_of(const CellGrid& grid, int column, const Visit& visit) {
    const GridFrame& frame = grid.frame();
    const std::span<const LocalIndex> order = grid.order();
    const SlotRange all = grid.run(column, 0, frame.n_rows - 1);
    for (std::uint32_t slot = all.begin; slot < all.end; ++slot) {
        const int row = grid.row_of(order[slot]);
        for (int other = column; other <= std::min(column + frame.n_reach, frame.n_columns - 1); ++other) {
            const SlotRange run = grid.run(other, row - frame.n_reach, row + frame.n_reach);
            for (std::uint32_t k = other == column ? slot + 1 : run.begin; k < run.end; ++k) visit(order[slot], order[k]);
        }
    }
}

/// Calls `visit(a, b)` once for each two discs in cells that lie within the grid's reach of each other.
template <class Visit> void visit_near_pairs(const CellGrid& grid, const Visit& visit) {
    for (int column = 0; column < grid.frame().n_columns; ++column) visit_near_pairs_of(grid, column, visit);
}

} // namespace carrom

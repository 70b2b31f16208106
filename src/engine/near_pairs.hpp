// SPDX-License-Identifier: BSD-3-Clause
// Visits all pairs of discs in neighbouring cells of a grid, each pair once.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"

namespace carrom {

/// Visits pairs whose first disc is an own disc in `column`. The second disc is in the same or a
/// higher column, or in the halo. Pairs of two halo discs are left to other ranks.
template <class Visit>
void visit_near_pairs_of(const CellGrid& grid, int column, const Visit& visit) {
    const GridGeometry& geometry = grid.geometry();
    const int last_column = std::min(column + geometry.n_reach, geometry.n_columns - 1);
    for (int row = 0; row < geometry.n_rows; ++row) {
        const SlotRange cell = grid.run(column, row, row);
        if (cell.begin == cell.end) continue;
        for (int other = column; other <= last_column; ++other) {
            const SlotRange run = grid.run(other, row - geometry.n_reach, row + geometry.n_reach);
            for (LocalIndex index = cell.begin; index < cell.end; ++index)
                for (LocalIndex second = other == column ? index + 1 : run.begin; second < run.end;
                     ++second)
                    visit(index, second);
        }
        for (int other = std::max(column - geometry.n_reach, 0); other <= last_column; ++other) {
            const SlotRange run = grid.halo_run(other, row - geometry.n_reach,
                                                row + geometry.n_reach);
            for (LocalIndex index = cell.begin; index < cell.end; ++index)
                for (std::uint32_t slot = run.begin; slot < run.end; ++slot)
                    visit(index, grid.halo_index(slot));
        }
    }
}

/// Calls `visit(a, b)` once for each pair of discs whose cells are within the grid's reach of each
/// other, if at least one of the two is an own disc.
template <class Visit> void visit_near_pairs(const CellGrid& grid, const Visit& visit) {
    for (int column = 0; column < grid.geometry().n_columns; ++column)
        visit_near_pairs_of(grid, column, visit);
}

/// Calls `visit(index, id of the other, distance)` for each own disc and each other disc or image
/// within `reach`. Distances and `reach` are in units of `unit`; states are at time 0.
template <class Visit>
void visit_pairs_within(const CellGrid& grid, const Population& all, const Periods& periods,
                        double unit, double reach, const Visit& visit) {
    visit_near_pairs(grid, [&](LocalIndex a, LocalIndex b) {
        const DiscState &p = all.discs[a], &q = all.discs[b];
        const Shift shift = periods.between(p, q, 0);
        const double dx = q.x - p.x + shift.x, dy = q.y - p.y + shift.y,
                     distance = std::sqrt(dx * dx + dy * dy) / unit;
        if (distance > reach) return;
        if (a < all.n_own) visit(a, q.id, distance);
        if (b < all.n_own) visit(b, p.id, distance);
    });
}

} // namespace carrom

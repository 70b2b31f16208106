// SPDX-License-Identifier: BSD-3-Clause
// Cells by several threads against the cell of each disc, looked up alone: discs in order, nearly so, and in none.
#include "carrom/collision/cell_grid.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

using carrom::CellGrid;
using carrom::Disc;
using carrom::GridFrame;
using carrom::LocalIndex;

namespace {

constexpr double box = 200;

std::vector<Disc> gas(std::mt19937& random, std::size_t n) {
    std::uniform_real_distribution<double> place(-1, box + 1), velocity(-1, 1); // some outside: they belong to border cells
    std::vector<Disc> discs(n);
    for (std::size_t i = 0; i < n; ++i) {
        discs[i].x = place(random);
        discs[i].y = place(random);
        discs[i].vx = velocity(random);
        discs[i].vy = velocity(random);
        discs[i].id = i;
    }
    return discs;
}

void check_cells(const CellGrid& grid, const std::vector<Disc>& discs, double time) {
    const GridFrame& frame = grid.frame();
    REQUIRE(grid.is_valid(discs.size()));
    std::vector<bool> is_placed(discs.size(), false);
    for (int column = 0; column < frame.n_columns; ++column) {
        for (int row = 0; row < frame.n_rows; ++row) {
            const carrom::SlotRange cell = grid.run(column, row, row);
            REQUIRE(cell.begin <= cell.end);
            for (std::uint32_t slot = cell.begin; slot < cell.end; ++slot) {
                const LocalIndex index = grid.order()[slot];
                REQUIRE_FALSE(is_placed[index]);
                is_placed[index] = true;
                REQUIRE(frame.column_of(discs[index].x_at(time)) == column);
                REQUIRE(frame.row_of(discs[index].y_at(time)) == row);
            }
        }
    }
    REQUIRE(std::count(is_placed.begin(), is_placed.end(), true) == static_cast<std::ptrdiff_t>(discs.size()));
}

void check_flights(const CellGrid& grid, const std::vector<Disc>& discs, double time, double duration) {
    const GridFrame& frame = grid.frame();
    for (std::size_t slot = 0; slot < discs.size(); ++slot) {
        const Disc& disc = discs[grid.order()[slot]];
        CHECK(grid.lanes().x[slot] == Approx((disc.x_at(time) - frame.x_low) / frame.cell_width).epsilon(1e-5).margin(1e-5));
        CHECK(grid.lanes().vy[slot] == Approx(disc.vy * duration / frame.cell_width).epsilon(1e-5).margin(1e-5));
    }
}

} // namespace

TEST_CASE("threads put discs into the cells in which they are") {
    std::mt19937 random(11);
    const double time = 0.7, duration = 3;
    for (const std::size_t n : {0, 1, 3, 500, 4000}) {
        for (const double reach : {2.0, 9.0, 150.0, 400.0}) {
            for (const int n_threads : {1, 2, 3, 5, 16}) {
                std::vector<Disc> discs = gas(random, n);
                const GridFrame frame = carrom::make_frame(0, box, 0, box, reach, n, 0);
                CellGrid grid;
                grid.build(discs, frame, time, time, duration, n_threads); // in no order
                check_cells(grid, discs, time);
                check_flights(grid, discs, time, duration);
                grid.reorder(discs, discs.size(), n_threads);
                grid.build(discs, frame, time, time, duration, n_threads); // in order
                check_cells(grid, discs, time);
                for (Disc& disc : discs) disc.x += 5 * disc.vx;
                const std::vector<Disc> arrived = gas(random, n / 10);
                discs.insert(discs.end(), arrived.begin(), arrived.end());
                grid.build_cells(discs, frame, time, n_threads); // nearly in order, and some of anywhere behind
                check_cells(grid, discs, time);
            }
        }
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Discs sorted by several threads, compared with the cell of each disc: for discs in order, nearly
// in order, and in no order.
#include "cell_list/cell_grid.hpp"

#include <algorithm>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "catch.hpp"

using carrom::Axis;
using carrom::CellGrid;
using carrom::DiscState;
using carrom::GridGeometry;
using carrom::LocalIndex;

namespace {

constexpr double box = 200;

std::vector<DiscState> gas(std::mt19937& random, std::size_t n) {
    std::uniform_real_distribution<double> place(-1, box + 1),
        velocity(-1, 1); // discs outside of the box belong to border cells
    std::vector<DiscState> discs(n);
    for (std::size_t i = 0; i < n; ++i) {
        discs[i].x = place(random);
        discs[i].y = place(random);
        discs[i].vx = velocity(random);
        discs[i].vy = velocity(random);
        discs[i].id = i;
    }
    return discs;
}

/// Checks that each disc occurs once, in the run of its cell, and is unchanged; `before` has the
/// discs by id.
void check_cells(const CellGrid& grid, const std::vector<DiscState>& discs, double time,
                 const std::vector<DiscState>& before) {
    const GridGeometry& geometry = grid.geometry();
    REQUIRE(grid.is_valid(discs.size()));
    std::vector<bool> is_placed(discs.size(), false), is_there(discs.size(), false);
    const auto check = [&](LocalIndex index, int column, int row) {
        REQUIRE_FALSE(is_placed[index]);
        is_placed[index] = true;
        REQUIRE(geometry.column_of(discs[index].x_at(time)) == column);
        REQUIRE(geometry.row_of(discs[index].y_at(time)) == row);
    };
    for (int column = 0; column < geometry.n_columns; ++column) {
        for (int row = 0; row < geometry.n_rows; ++row) {
            const carrom::SlotRange cell = grid.run(column, row, row),
                                    of_halo = grid.halo_run(column, row, row);
            REQUIRE(cell.begin <= cell.end);
            for (LocalIndex index = cell.begin; index < cell.end; ++index) {
                check(index, column, row);
                REQUIRE(grid.cell_of(index).column == column);
                REQUIRE(grid.cell_of(index).row == row);
            }
            for (std::uint32_t slot = of_halo.begin; slot < of_halo.end; ++slot) {
                check(grid.halo_index(slot), column, row);
                REQUIRE(grid.halo_slot(grid.halo_index(slot)) == slot);
            }
        }
    }
    REQUIRE(std::count(is_placed.begin(), is_placed.end(), true) ==
            static_cast<std::ptrdiff_t>(discs.size()));
    for (const DiscState& disc : discs) {
        REQUIRE_FALSE(is_there[disc.id]);
        is_there[disc.id] = true;
        REQUIRE((disc.x == before[disc.id].x && disc.y == before[disc.id].y &&
                 disc.vx == before[disc.id].vx && disc.vy == before[disc.id].vy));
    }
}

void check_flight(const GridGeometry& geometry, const carrom::FlightLanes& lanes,
                  std::uint32_t slot, const DiscState& disc, double time, double duration) {
    CHECK(
        lanes.x[slot] ==
        Approx((disc.x_at(time) - geometry.low) / geometry.cell_width).epsilon(1e-5).margin(1e-5));
    CHECK(lanes.y[slot] == Approx((disc.y_at(time) - geometry.across_low) / geometry.cell_width)
                               .epsilon(1e-5)
                               .margin(1e-5));
    CHECK(lanes.vx[slot] ==
          Approx(disc.vx * duration / geometry.cell_width).epsilon(1e-5).margin(1e-5));
    CHECK(lanes.vy[slot] ==
          Approx(disc.vy * duration / geometry.cell_width).epsilon(1e-5).margin(1e-5));
}

void check_flights(const CellGrid& grid, const std::vector<DiscState>& discs, double time,
                   double duration) {
    for (LocalIndex index = 0; index < discs.size(); ++index) {
        if (index < grid.n_own())
            check_flight(grid.geometry(), grid.lanes(), index, discs[index], time, duration);
        else
            check_flight(grid.geometry(), grid.halo_lanes(), grid.halo_slot(index), discs[index],
                         time, duration);
    }
}

} // namespace

TEST_CASE("side columns and companions go where discs go") {
    std::mt19937 random(5);
    std::vector<DiscState> discs = gas(random, 3000);
    std::vector<DiscState> companions = discs;
    carrom::SideColumns columns;
    columns.add(carrom::SideColumn::spin);
    columns.resize(discs.size());
    const auto number_of = [](const DiscState& disc) {
        return 0.5 * static_cast<double>(disc.id) - 7;
    };
    for (const int n_threads : {1, 3}) {
        for (const double time : {0.0, 4.0}) { // first in no order, then nearly in order
            for (std::size_t i = 0; i < discs.size(); ++i)
                columns[carrom::SideColumn::spin][i] = number_of(discs[i]);
            CellGrid grid;
            const GridGeometry geometry = carrom::make_geometry({0, box, 0, box}, Axis::x, 4,
                                                                discs.size(), 0);
            grid.sort_cells(discs, geometry, time, n_threads, {}, {companions, &columns});
            for (std::size_t i = 0; i < discs.size(); ++i) {
                REQUIRE(companions[i].id == discs[i].id);
                REQUIRE(columns[carrom::SideColumn::spin][i] == number_of(discs[i]));
            }
        }
        std::shuffle(discs.begin(), discs.end(), random);
        companions = discs;
    }
}

TEST_CASE("threads bring discs into the order of the cells in which they are") {
    std::mt19937 random(11);
    const double time = 0.7, duration = 3;
    for (const std::size_t n : {0u, 1u, 3u, 500u, 4000u, 20000u}) {
        for (const double reach : {2.0, 9.0, 150.0, 400.0}) {
            for (const int n_threads : {1, 2, 3, 5, 16}) {
                std::vector<DiscState> discs = gas(random, n);
                std::vector<DiscState> before = discs;
                const GridGeometry geometry = carrom::make_geometry({0, box, 0, box}, Axis::x,
                                                                    reach, n, 0);
                CellGrid grid;
                // discs are in no order
                grid.sort(discs, geometry, time, time, duration, n_threads);
                check_cells(grid, discs, time, before);
                check_flights(grid, discs, time, duration);
                for (DiscState& disc : discs) disc.x += 5 * disc.vx;
                const std::vector<DiscState> arrived = gas(random, n / 10);
                for (const DiscState& disc : arrived) {
                    discs.push_back(disc);
                    discs.back().id = discs.size() - 1;
                }
                before.resize(discs.size());
                for (const DiscState& disc : discs) before[disc.id] = disc;
                std::vector<DiscState> twins = discs; // companions must go where the discs go
                // Discs are nearly in order, with some new ones anywhere at the end.
                grid.sort(discs, geometry, time, time, duration, n_threads, {}, {twins, nullptr});
                check_cells(grid, discs, time, before);
                check_flights(grid, discs, time, duration);
                for (std::size_t i = 0; i < discs.size(); ++i) REQUIRE(twins[i].id == discs[i].id);
                grid.sort_cells(discs, geometry, time, n_threads); // discs are in order
                check_cells(grid, discs, time, before);
            }
        }
    }
}

TEST_CASE(
    "a halo's discs have cells of their own where there are any, and flights that can be changed") {
    std::mt19937 random(12);
    const double time = 2, duration = 4;
    for (const std::size_t n : {0u, 1u, 40u, 2000u, 9000u}) {
        for (const double reach : {2.0, 30.0}) {
            std::vector<DiscState> discs = gas(random, 1000);
            const std::vector<DiscState> halo = gas(random, n);
            const GridGeometry geometry = carrom::make_geometry({0, box, 0, box}, Axis::x, reach,
                                                                discs.size(), 0);
            CellGrid grid;
            grid.sort(discs, geometry, time, time, duration, 1);
            for (const DiscState& disc : halo) {
                discs.push_back(disc);
                discs.back().x *= 0.3; // most columns have no halo discs
                discs.back().id = discs.size() - 1;
            }
            CellGrid by_threads = grid;
            grid.add_halo(std::span<const DiscState>(discs).subspan(1000));
            by_threads.add_halo(std::span<const DiscState>(discs).subspan(1000), 3);
            bool are_same = true; // slots are compared, because searches must not depend on threads
            for (std::uint32_t slot = 0; slot < n; ++slot)
                are_same = are_same && by_threads.halo_index(slot) == grid.halo_index(slot) &&
                           by_threads.halo_lanes().vy[slot] == grid.halo_lanes().vy[slot];
            CHECK(are_same);
            CHECK(by_threads.is_valid(discs.size()));
            std::vector<DiscState> before(discs.size());
            for (const DiscState& disc : discs) before[disc.id] = disc;
            check_cells(grid, discs, time, before);
            for (LocalIndex index = 0; index < discs.size(); index += 7) {
                discs[index].vx = -discs[index].vy;
                grid.update_flight(index, discs[index]);
            }
            check_flights(grid, discs, time, duration);
        }
    }
}

TEST_CASE("no disc outside of an inner part is left out of those that are listed for it") {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> edge(-20, box + 20);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double reach : {1.0, 7.0, 90.0, 500.0}) {
        std::vector<DiscState> discs = gas(random, 3000);
        CellGrid grid;
        grid.sort(discs, carrom::make_geometry({0, box, 0, box}, Axis::x, reach, discs.size(), 0),
                  1, 1, 1, 1);
        for (int k = 0; k < 200; ++k) {
            carrom::Inside inner{edge(random), edge(random), edge(random), edge(random)};
            if (k % 3 == 0) inner.y_low = -infinity, inner.y_high = infinity;
            if (k % 5 == 0) inner.x_low = -infinity;
            if (k % 7 == 0) inner.x_high = infinity;
            std::vector<bool> is_listed(discs.size(), false);
            std::uint32_t last = 0;
            for (const carrom::SlotRange range : grid.outside(inner)) {
                REQUIRE(range.begin >= last);
                REQUIRE(range.begin < range.end);
                last = range.end;
                for (std::uint32_t i = range.begin; i < range.end; ++i) is_listed[i] = true;
            }
            for (std::size_t i = 0; i < discs.size(); ++i)
                if (!inner.holds(discs[i].x_at(1), discs[i].y_at(1))) REQUIRE(is_listed[i]);
        }
    }
    std::vector<DiscState> discs = gas(random, 100'000);
    CellGrid grid;
    grid.sort(discs, carrom::make_geometry({0, box, 0, box}, Axis::x, 2, discs.size(), 0), 0, 0, 1,
              1);
    std::size_t n_listed = 0;
    for (const carrom::SlotRange range : grid.outside({20, 180, -infinity, infinity}))
        n_listed += range.end - range.begin;
    CHECK(n_listed < 25'000); // a fifth of the box, and the columns at its edge
}

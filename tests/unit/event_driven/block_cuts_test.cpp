// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/block_cuts.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "catch.hpp"

#include "event_driven/cell_sums_fill.hpp"

using namespace carrom;

namespace {

/// Counts of discs in cells, column by column, in the place of a grid.
struct Counts {
    int n_columns = 0, n_rows = 0;
    std::vector<std::uint64_t> of_cell;

    std::uint64_t& at(int column, int row) {
        return of_cell[static_cast<std::size_t>(column * n_rows + row)];
    }
    std::uint64_t in(const CellBlock& part) {
        std::uint64_t n = 0;
        for (int column = part.first_column; column < part.end_column; ++column)
            for (int row = part.first_row; row < part.end_row; ++row) n += at(column, row);
        return n;
    }
    CellSums sums() {
        CellSums filled;
        filled.fill(all(), 2, {1, 0}, [this](int column, int row) {
            const std::uint64_t more = 1000; // the number of discs in earlier columns
            return static_cast<std::uint32_t>(more + in({column, column + 1, 0, row}));
        });
        return filled;
    }
    CellBlock all() const { return {0, n_columns, 0, n_rows}; }
};

/// One disc in each cell, and `crowd` discs in each cell of the lower left corner, a tenth of both
/// sides.
Counts crowded(int n_columns, int n_rows, std::uint64_t crowd) {
    Counts counts{n_columns, n_rows, {}};
    counts.of_cell.assign(static_cast<std::size_t>(n_columns * n_rows), 1);
    for (int column = 0; column < n_columns / 10; ++column)
        for (int row = 0; row < n_rows / 10; ++row) counts.at(column, row) = crowd;
    return counts;
}

/// Each cell lies in exactly one block, which block_of finds.
void check_cover(const BlockCuts& cuts, const CellBlock& cells) {
    std::vector<int> n_times(static_cast<std::size_t>(cells.end_column * cells.end_row), 0);
    for (std::size_t k = 0; k < cuts.blocks().size(); ++k) {
        const CellBlock& block = cuts.blocks()[k];
        for (int column = block.first_column; column < block.end_column; ++column)
            for (int row = block.first_row; row < block.end_row; ++row) {
                ++n_times[static_cast<std::size_t>(column * cells.end_row + row)];
                CHECK(cuts.block_of(column, row) == k);
            }
    }
    for (int column = 0; column < cells.end_column; ++column)
        for (int row = 0; row < cells.end_row; ++row)
            CHECK(n_times[static_cast<std::size_t>(column * cells.end_row + row)] ==
                  (column >= cells.first_column && row >= cells.first_row ? 1 : 0));
}

} // namespace

TEST_CASE("block cuts: even blocks cover all cells, the last ones with what is left") {
    BlockCuts cuts;
    const CellBlock cells{3, 25, 2, 13};
    cuts.cut_evenly(cells, 5, 4);
    CHECK(cuts.blocks().size() == 5 * 3);
    check_cover(cuts, cells);
    for (const CellBlock& block : cuts.blocks()) {
        CHECK((block.first_column - 3) % 5 == 0);
        CHECK((block.first_row - 2) % 4 == 0);
        CHECK(block.n_columns() <= 5);
        CHECK(block.n_rows() <= 4);
    }
}

TEST_CASE("block cuts: where discs crowd, no block sees much more work than the others") {
    Counts counts = crowded(400, 300, 100);
    const CellSums sums = counts.sums();
    const int halo = 2;
    BlockCuts cuts;
    for (const std::size_t n_blocks : {7u, 16u, 32u}) { // blocks have several cells along each side
        cuts.cut_by_work(counts.all(), {n_blocks, halo, counts.all()}, sums);
        CHECK(cuts.blocks().size() == n_blocks);
        check_cover(cuts, counts.all());
        double most = 0, all = 0;
        for (const CellBlock& block : cuts.blocks()) {
            const auto seen = static_cast<double>(
                counts.in(block.widened(halo).within(counts.all())));
            most = std::max(most, seen);
            all += seen;
        }
        CHECK(most * static_cast<double>(n_blocks) < 1.3 * all);
    }
}

TEST_CASE("block cuts: halos of other strips count as much as own cells") {
    Counts counts = crowded(96, 96, 1); // counts with the same work in all cells
    const CellSums sums = counts.sums();
    BlockCuts cuts;
    cuts.cut_by_work(counts.all(), {9, 8, {-8, 104, -8, 104}}, sums);
    CHECK(cuts.blocks().size() == 9);
    std::uint64_t least = 96 * 96, most = 0;
    for (const CellBlock& block : cuts.blocks()) {
        least = std::min(least, counts.in(block));
        most = std::max(most, counts.in(block));
    }
    CHECK(static_cast<double>(most) < 1.2 * static_cast<double>(least));
}

TEST_CASE("block cuts: there are no more blocks than cells, and one where there is no work") {
    Counts few = crowded(3, 2, 1), none = crowded(40, 40, 0);
    std::fill(none.of_cell.begin(), none.of_cell.end(), 0);
    BlockCuts cuts;
    cuts.cut_by_work(few.all(), {64, 1, few.all()}, few.sums());
    CHECK(cuts.blocks().size() == 6);
    check_cover(cuts, few.all());
    cuts.cut_by_work(none.all(), {8, 1, none.all()}, none.sums());
    CHECK(cuts.blocks().size() == 1);
}

TEST_CASE("block cuts: sums hold the work of any rectangle, and where in it there is any") {
    Counts counts = crowded(90, 150, 7); // more rows than one thread handles at once
    for (std::size_t k = 0; k < counts.of_cell.size(); ++k) counts.of_cell[k] += k * k % 11;
    const CellSums sums = counts.sums();
    for (const CellBlock& part : {counts.all(), CellBlock{4, 5, 3, 4}, CellBlock{10, 60, 63, 68},
                                  CellBlock{87, 88, 3, 149}, CellBlock{20, 20, 3, 149}})
        CHECK(sums.in(part) == counts.in(part));
    CHECK(CellWork{3, 2}.of(0) == 0);
    CHECK(CellWork{3, 2}.of(5) == 5 * 3 + 5 * 4 * 2);
    Counts lone{30, 80, std::vector<std::uint64_t>(30 * 80, 0)};
    lone.at(7, 70) = lone.at(9, 66) = 1;
    const CellBlock found = lone.sums().occupied({2, 29, 1, 80});
    CHECK(found.first_column == 7);
    CHECK(found.end_column == 10);
    CHECK(found.first_row == 66);
    CHECK(found.end_row == 71);
}

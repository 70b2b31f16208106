// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/block_cuts.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "catch.hpp"

using namespace carrom;

namespace {

/// Counts of discs in cells, column by column, which a grid would have.
struct Counts {
    int n_columns = 0, n_rows = 0;
    std::vector<std::uint64_t> of_cell;

    std::uint64_t& at(int column, int row) {
        return of_cell[static_cast<std::size_t>(column * n_rows + row)];
    }
    CellCount count() {
        return [this](int column, int first_row, int end_row) {
            std::uint64_t n = 0;
            for (int row = first_row; row < end_row; ++row) n += at(column, row);
            return n;
        };
    }
    CellBlock all() const { return {0, n_columns, 0, n_rows}; }
};

/// One disc in each cell, and `crowd` in those of the lower left tenth of both sides.
Counts crowded(int n_columns, int n_rows, std::uint64_t crowd) {
    Counts counts{n_columns, n_rows, {}};
    counts.of_cell.assign(static_cast<std::size_t>(n_columns * n_rows), 1);
    for (int column = 0; column < n_columns / 10; ++column)
        for (int row = 0; row < n_rows / 10; ++row) counts.at(column, row) = crowd;
    return counts;
}

/// Each cell lies in just one block, and block_of finds that.
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

TEST_CASE("block cuts: where discs crowd, no block has much more than its part of the work") {
    Counts counts = crowded(200, 150, 100);
    BlockCuts cuts;
    CutNeeds needs;
    needs.halo = 2;
    for (const std::size_t n_blocks : {7u, 32u, 100u}) {
        needs.n_blocks = n_blocks;
        cuts.cut_by_work(counts.all(), needs, counts.count());
        check_cover(cuts, counts.all());
        double most = 0, all = 0;
        for (const CellBlock& block : cuts.blocks()) {
            double seen = 0;
            for (int column = std::max(0, block.first_column - 2);
                 column < std::min(200, block.end_column + 2); ++column)
                for (int row = std::max(0, block.first_row - 2);
                     row < std::min(150, block.end_row + 2); ++row)
                    seen += static_cast<double>(counts.at(column, row));
            most = std::max(most, seen);
            all += seen;
        }
        CHECK(most * static_cast<double>(n_blocks) < 1.4 * all);
        CHECK(cuts.blocks().size() < 3 * n_blocks);
    }
}

TEST_CASE("block cuts: no block is narrower than it may be, nor sees too many discs for that") {
    Counts counts = crowded(120, 120, 1000);
    BlockCuts cuts;
    CutNeeds needs;
    needs.least = 3;
    needs.n_blocks = 1;
    needs.most_seen = 1500;
    cuts.cut_by_work(counts.all(), needs, counts.count());
    check_cover(cuts, counts.all());
    for (const CellBlock& block : cuts.blocks()) {
        CHECK(std::min(block.n_columns(), block.n_rows()) >= 3);
        if (block.first_column >= 13 && block.first_row >= 13)
            CHECK((block.n_columns() + 2) * (block.n_rows() + 2) <= 1500 * 4);
        if (block.end_column <= 11 && block.end_row <= 11)
            CHECK(std::max(block.n_columns(), block.n_rows()) < 6); // could not be cut again
    }
}

TEST_CASE("block cuts: a crowd is uneven, one disc in each cell is not, and no disc is no crowd") {
    BlockCuts cuts;
    Counts crowd = crowded(40, 40, 100), even = crowded(40, 40, 1), none = crowded(40, 40, 0);
    cuts.cut_evenly(even.all(), 10, 10);
    CHECK(cuts.is_uneven(1.5, crowd.count()));
    CHECK_FALSE(cuts.is_uneven(1.5, even.count()));
    std::fill(none.of_cell.begin(), none.of_cell.end(), 0);
    CHECK_FALSE(cuts.is_uneven(1.5, none.count()));
    CutNeeds needs;
    needs.n_blocks = 8;
    cuts.cut_by_work(none.all(), needs, none.count());
    CHECK(cuts.blocks().size() == 1);
    CHECK(pairs_in_cells(none.all(), none.count()) == 0);
    CHECK(pairs_in_cells(even.all(), even.count()) == 0);
    CHECK(pairs_in_cells(crowd.all(), crowd.count()) == 16 * 100 * 99);
}

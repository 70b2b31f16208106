// SPDX-License-Identifier: BSD-3-Clause
// How the cells of a strip are cut into blocks. Where discs are spread evenly, blocks have equal
// areas. Where they crowd, blocks have about equal work, because the block with most work decides
// how long all threads wait. The cuts affect the run's time, not its bits.
//
// The cells are halved again and again, so that blocks stay as square as they can be: a square has
// the least halo. The work of a block is estimated from the discs that it sees, its halo included,
// and from their density. Price: some hundred reads of the cell list for each block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace carrom {

/// A rectangle of cells.
struct CellBlock {
    int first_column = 0, end_column = 0;
    int first_row = 0, end_row = 0;

    int n_columns() const { return end_column - first_column; }
    int n_rows() const { return end_row - first_row; }
};

/// Returns the number of discs in the cells of one column from a first row to before an end.
using CellCount = std::function<std::uint64_t(int column, int first_row, int end_row)>;

/// The number of pairs of discs in one cell, each counted twice, summed over `cells`.
std::uint64_t pairs_in_cells(const CellBlock& cells, const CellCount& count);

/// What a block costs, and how small blocks may become.
struct CutNeeds {
    int halo = 1;                 ///< cells that a block sees around its own
    int least = 1;                ///< cells along a block's side
    std::size_t n_blocks = 1;     ///< no block has more than its part of the work, if it can be cut
    double most_seen = 1e9;       ///< discs that a block sees, if it can be cut
    double work_per_disc = 1;     ///< for each disc that it sees
    double work_per_crowding = 0; ///< for each disc, times the number of discs in a cell
};

class BlockCuts {
public:
    /// Cuts `cells` into blocks of `block_columns` by `block_rows` cells.
    void cut_evenly(const CellBlock& cells, int block_columns, int block_rows);
    /// Cuts `cells` into blocks of about equal work.
    void cut_by_work(const CellBlock& cells, const CutNeeds& needs, const CellCount& count);
    /// Whether the block with most discs has more than `ratio` times the mean.
    bool is_uneven(double ratio, const CellCount& count) const;

    /// Blocks that touch follow each other, as far as possible.
    const std::vector<CellBlock>& blocks() const { return blocks_; }
    /// The block that holds a cell of the strip.
    std::size_t block_of(int column, int row) const;

private:
    /// A rectangle that is a block, or is cut in two.
    struct Node {
        bool is_block = true, is_cut_by_column = false;
        int cut = 0;                 ///< where the upper part begins
        std::size_t lower = 0, upper = 0; ///< nodes; `lower` is the block's number if it is one
    };
    /// Decides where to cut a rectangle, along which axis; false makes it a block.
    using Decision = std::function<bool(const CellBlock& part, bool& by_column, int& cut)>;

    void cut(const CellBlock& cells, const Decision& decide);
    std::size_t add(const CellBlock& part, const Decision& decide);

    std::vector<CellBlock> blocks_;
    std::vector<Node> nodes_; ///< the first one is all cells
};

} // namespace carrom

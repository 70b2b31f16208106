// SPDX-License-Identifier: BSD-3-Clause
// How the cells of a strip are cut into blocks: into columns of blocks first, and each of those into
// blocks above each other. Where discs are spread evenly, blocks have equal areas. Where they
// crowd, blocks have equal numbers of discs, since the largest block decides how long all threads
// wait. The cuts affect the run's time, not its bits.
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
};

/// Returns the number of discs in the cells of one column from a first row to before an end.
using CellCount = std::function<std::uint64_t(int column, int first_row, int end_row)>;

/// How many others each disc has in its cell, summed over discs. Price: one call for each cell.
std::uint64_t pairs_in_cells(const CellBlock& cells, const CellCount& count);

class BlockCuts {
public:

    /// Cuts `cells` into blocks of `block_columns` by `block_rows` cells. If the fullest of them has
    /// too many discs for its share, it cuts them into about as many blocks by number, of which none
    /// is narrower or lower than `least` cells. Price: one call of `count` for each block and column
    /// of cells, and where discs crowd one for each cell.
    void cut(const CellBlock& cells, int block_columns, int block_rows, int least,
             const CellCount& count);

    std::size_t n_blocks() const { return rows_.size() * n_rows(); }
    /// Blocks follow each other from below, column by column.
    CellBlock block(std::size_t k) const;
    /// The block that holds a cell of the strip.
    std::size_t block_of(int column, int row) const;

private:
    std::size_t n_rows() const { return rows_.front().size() - 1; }

    std::vector<int> columns_;           ///< where each column of blocks begins, and the end
    std::vector<std::vector<int>> rows_; ///< by column of blocks: where its blocks begin, and the end
};

/// Returns where `n_parts` parts of about equal weight begin, and the number of weights at the end.
/// Each has `least` weights or more, so there may be fewer parts.
std::vector<int> cuts_by_weight(const std::vector<std::uint64_t>& weights, int n_parts, int least);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Cuts the cells of a rank into blocks. If the rank has one thread and discs are spread evenly, the
// blocks have equal areas. Otherwise they have about equal work, because all threads wait for the
// block with the most work. The cuts affect the run's time, not its bits.
//
// The cells are halved repeatedly across their longer side, so that blocks are nearly square,
// because a square has the smallest halo. The work of a block includes its halo. Cost: two passes
// over the cells, shared by the threads, and four bytes per cell while the blocks are cut.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/raw_vector.hpp"

namespace carrom {

/// A rectangle of cells of a grid: columns and rows [first, end).
struct CellBlock {
    int first_column = 0, end_column = 0;
    int first_row = 0, end_row = 0;

    int n_columns() const { return end_column - first_column; }
    int n_rows() const { return end_row - first_row; }
    double area() const { return static_cast<double>(n_columns()) * n_rows(); }
    CellBlock widened(int by) const {
        return {first_column - by, end_column + by, first_row - by, end_row + by};
    }
    CellBlock within(const CellBlock& other) const {
        return {std::max(first_column, other.first_column), std::min(end_column, other.end_column),
                std::max(first_row, other.first_row), std::min(end_row, other.end_row)};
    }
};

/// Estimates the work of a cell from its number of discs, in whole units that the caller chooses.
struct CellWork {
    std::uint32_t per_disc = 1, per_pair = 0; ///< per disc, and per ordered pair of discs in a cell

    std::uint32_t of(std::uint32_t n_discs) const {
        return n_discs * (per_disc + (n_discs - 1) * per_pair);
    }
};

/// Computes the total work of the cells in any rectangle from four numbers of a table.
class CellSums {
public:
    /// `discs_before(column, row)` is the number of discs in this column in all rows below `row`,
    /// plus a constant that may differ between columns. The total work of `cells` must be less
    /// than 2^32. Defined in cell_sums_fill.hpp.
    template <class DiscsBefore>
    void fill(const CellBlock& cells, int n_threads, const CellWork& work,
              const DiscsBefore& discs_before);
    std::uint64_t in(const CellBlock& part) const;
    /// The smallest rectangle that contains all work of `part`.
    CellBlock occupied(CellBlock part) const;

private:
    std::size_t place(int column, int row) const {
        return static_cast<std::size_t>(column - cells_.first_column) *
                   static_cast<std::size_t>(cells_.n_rows() + 1) +
               static_cast<std::size_t>(row - cells_.first_row);
    }

    CellBlock cells_;
    /// For each cell, the total work of all cells that are both to its left and below it
    RawVector<std::uint32_t> sums_;
};

struct CutNeeds {
    std::size_t n_blocks = 1;
    int halo = 1;    ///< width of a block's halo, in cells
    CellBlock frame; ///< all cells of the grid, including those for other ranks' discs and images
};

class BlockCuts {
public:
    /// Cuts `cells` into blocks of `block_columns` by `block_rows` cells.
    void cut_evenly(const CellBlock& cells, int block_columns, int block_rows);
    /// Cuts `cells` into blocks of about equal work, or into fewer blocks if there are too few
    /// cells. `sums` must have been filled for the same cells.
    void cut_by_work(const CellBlock& cells, const CutNeeds& needs, const CellSums& sums);

    /// The blocks, in an order in which neighbours follow each other as far as possible.
    const std::vector<CellBlock>& blocks() const { return blocks_; }
    /// The expected work of each block with its halo, in units of CellWork; empty after cut_evenly.
    const std::vector<double>& work() const { return work_; }
    /// The index in `blocks()` of the block that contains this cell.
    std::size_t block_of(int column, int row) const;

private:
    /// A rectangle that is a block or is divided into two parts.
    struct Node {
        bool is_block = true, is_cut_by_column = false;
        int cut = 0; ///< first column or row of the upper part of a divided rectangle
        /// Indices of the nodes of both parts; for a block, `lower` is its index in `blocks_`
        std::size_t lower = 0, upper = 0;
    };
    struct Cut {
        bool is_by_column = false;
        int at = 0;
        std::size_t middle = 0; ///< number of the first block of the upper part
    };
    /// Decides where to cut a rectangle that has room for the blocks [first, end). Returns false if
    /// the rectangle is to become one block.
    using Decision =
        std::function<bool(const CellBlock& part, std::size_t first, std::size_t end, Cut& cut)>;

    void cut(const CellBlock& cells, std::size_t n_blocks, const Decision& decide);
    std::size_t add(const CellBlock& part, std::size_t first, std::size_t end,
                    const Decision& decide);

    std::vector<CellBlock> blocks_;
    std::vector<std::size_t> numbers_; ///< for each block, the index of its share in `shares_`
    std::vector<Node> nodes_;          ///< the first node contains all cells
    std::vector<double> work_;         ///< expected work of each block with its halo, or empty
    std::vector<double> shares_; ///< wanted work of blocks without halos; only the ratios matter
};

} // namespace carrom

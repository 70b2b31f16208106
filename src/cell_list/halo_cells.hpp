// SPDX-License-Identifier: BSD-3-Clause
// The discs of a halo, sorted into cells. Only columns that contain halo discs have cells, because
// a halo lies near the ends of a strip. All threads of a rank sort together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/disc_state.hpp"
#include "core/raw_vector.hpp"

namespace carrom {

class HaloCells {
public:
    /// Allocates memory for `n_discs` discs. Several threads may then call `set_cell` at the same
    /// time.
    void begin(std::size_t n_discs, int n_columns);
    void set_cell(std::size_t disc, int column, int row);
    /// Gives each disc a slot. Discs in the same cell keep the order of the halo.
    void sort(std::uint32_t n_rows, int n_threads);

    std::size_t size() const { return order_.size(); }
    bool is_empty() const { return order_.empty(); }
    bool has_column(int column) const {
        return !is_empty() && column_[static_cast<std::size_t>(column)] != no_discs;
    }
    /// The index of the column's first cell in `starts()`.
    std::uint32_t first_cell(int column) const { return column_[static_cast<std::size_t>(column)]; }
    /// The first row from `row` on that has discs in this column, or `n_rows` if no such row is
    /// left. The column must have discs.
    int next_row(int column, int row, int n_rows) const {
        if (row >= n_rows) return n_rows;
        const std::uint32_t* const of_rows = &start_[first_cell(column)];
        const std::uint32_t* const next = std::upper_bound(of_rows + row + 1, of_rows + n_rows + 1,
                                                           of_rows[row]);
        return std::min(static_cast<int>(next - of_rows) - 1, n_rows);
    }
    /// The first slot of each cell, and the end of the last one.
    const RawVector<std::uint32_t>& starts() const { return start_; }
    LocalIndex disc_in(std::uint32_t slot) const { return order_[slot]; }
    std::uint32_t slot_of(LocalIndex disc) const { return slot_[disc]; }
    bool is_valid() const;

private:
    static constexpr std::uint32_t no_discs = ~std::uint32_t{0};

    std::uint32_t number_columns(std::uint32_t n_rows);
    void turn_counts_into_starts(int n_threads);

    /// First cell of each column in `start_`; `no_discs` if the column is empty
    std::vector<std::uint32_t> column_;
    RawVector<std::uint32_t> start_; ///< first slot of each cell, and the last cell's end
    /// The disc of each slot; before sorting, the column of each disc
    RawVector<LocalIndex> order_;
    /// The slot of each disc; before sorting, the disc's row and later its cell
    RawVector<std::uint32_t> slot_;
};

} // namespace carrom

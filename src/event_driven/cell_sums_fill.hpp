// SPDX-License-Identifier: BSD-3-Clause
// Fills the table of CellSums. This function has a file of its own, because it needs OpenMP, and
// files that only use cuts do not.
#pragma once

#include "event_driven/block_cuts.hpp"

namespace carrom {

template <class DiscsBefore>
void CellSums::fill(const CellBlock& cells, int n_threads, const CellWork& work,
                    const DiscsBefore& discs_before) {
    cells_ = cells;
    sums_.resize(place(cells.end_column, cells.end_row) + 1);
    // Number of rows that a thread sums over all columns at a time
    constexpr int rows_each = 64;
    const int n_stretches = cells.n_rows() / rows_each + 1;
#pragma omp parallel num_threads(n_threads)
    {
#pragma omp for schedule(static)
        for (int column = cells.first_column; column < cells.end_column; ++column) {
            std::uint32_t* next = &sums_[place(column + 1, cells.first_row)];
            *next = 0;
            std::uint32_t before = discs_before(column, cells.first_row);
            for (int row = cells.first_row; row < cells.end_row; ++row, ++next) {
                const std::uint32_t end = discs_before(column, row + 1);
                next[1] = next[0] + work.of(end - before);
                before = end;
            }
        }
#pragma omp for schedule(static)
        for (int k = 0; k < n_stretches; ++k) {
            const int first = cells.first_row + k * rows_each;
            const int n = first + rows_each <= cells.end_row ? rows_each
                                                             : cells.end_row + 1 - first;
            for (int row = 0; row < n; ++row)
                sums_[place(cells.first_column, first) + static_cast<std::size_t>(row)] = 0;
            for (int column = cells.first_column; column < cells.end_column; ++column) {
                const std::uint32_t* from = &sums_[place(column, first)];
                std::uint32_t* to = &sums_[place(column + 1, first)];
                for (int row = 0; row < n; ++row) to[row] += from[row];
            }
        }
    }
}

} // namespace carrom

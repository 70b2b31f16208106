// SPDX-License-Identifier: BSD-3-Clause
#include "cell_list/halo_cells.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "cell_list/shared_work.hpp"

namespace carrom {

void HaloCells::begin(std::size_t n_discs, int n_columns) {
    order_.resize(n_discs);
    slot_.resize(n_discs);
    if (n_discs > 0) column_.assign(static_cast<std::size_t>(n_columns), no_discs);
}

void HaloCells::set_cell(std::size_t disc, int column, int row) {
    order_[disc] = static_cast<LocalIndex>(column);
    slot_[disc] = static_cast<std::uint32_t>(row);
    std::atomic_ref(column_[order_[disc]]).store(0, std::memory_order_relaxed);
}

/// Sets the first cell of each column that contains discs, and returns the number of cells.
std::uint32_t HaloCells::number_columns(std::uint32_t n_rows) {
    std::uint32_t n_cells = 0;
    for (std::uint32_t& column : column_)
        if (column != no_discs) column = std::exchange(n_cells, n_cells + n_rows);
    return n_cells;
}

/// Replaces the number of discs of each cell by the cell's first slot. Cell k has the entry
/// `start_[k + 1]`.
void HaloCells::turn_counts_into_starts(int n_threads) {
    const std::size_t n_cells = start_.size() - 1;
    const auto n_shares = static_cast<std::size_t>(n_threads);
    std::uint32_t* const counts = start_.data() + 1;
    std::vector<std::uint32_t> starts(n_shares + 1, 0); // first slot of each thread's share
#pragma omp parallel num_threads(n_threads)
    {
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k)
            starts[k + 1] = std::accumulate(counts + share(n_cells, k, n_shares),
                                            counts + share(n_cells, k + 1, n_shares),
                                            std::uint32_t{0});
#pragma omp single
        std::partial_sum(starts.begin(), starts.end(), starts.begin());
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            std::uint32_t start = starts[k];
            const std::size_t end = share(n_cells, k + 1, n_shares);
            for (std::size_t cell = share(n_cells, k, n_shares); cell < end; ++cell)
                start += std::exchange(counts[cell], start);
        }
    }
}

/// A counting sort. Threads fill the slots of a cell in any order, so the discs of each cell are
/// then sorted by their index in the halo.
void HaloCells::sort(std::uint32_t n_rows, int n_threads) {
    const std::size_t n_discs = size(), n_cells = number_columns(n_rows);
    const auto take = [n_threads](std::uint32_t& number) {
        return n_threads == 1 ? number++
                              : std::atomic_ref(number).fetch_add(1, std::memory_order_relaxed);
    };
    start_.resize(n_cells + 1);
    std::uint32_t* const next = start_.data() + 1;
#pragma omp parallel num_threads(n_threads)
    {
#pragma omp for schedule(static)
        for (std::size_t cell = 0; cell <= n_cells; ++cell) start_[cell] = 0;
#pragma omp for schedule(static)
        for (std::size_t i = 0; i < n_discs; ++i) {
            slot_[i] += column_[order_[i]];
            take(next[slot_[i]]);
        }
    }
    turn_counts_into_starts(n_threads);
#pragma omp parallel num_threads(n_threads)
    {
#pragma omp for schedule(static)
        for (std::size_t i = 0; i < n_discs; ++i)
            order_[take(next[slot_[i]])] = static_cast<LocalIndex>(i);
#pragma omp for schedule(static)
        for (std::size_t cell = 0; cell < n_cells; ++cell)
            if (n_threads > 1 && start_[cell + 1] - start_[cell] > 1)
                std::sort(order_.data() + start_[cell], order_.data() + start_[cell + 1]);
#pragma omp for schedule(static)
        for (std::size_t slot = 0; slot < n_discs; ++slot)
            slot_[order_[slot]] = static_cast<std::uint32_t>(slot);
    }
}

bool HaloCells::is_valid() const {
    for (std::size_t slot = 0; slot < size(); ++slot)
        if (slot_[order_[slot]] != slot) return false;
    return is_empty() || std::is_sorted(start_.begin(), start_.end());
}

} // namespace carrom

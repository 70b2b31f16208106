// SPDX-License-Identifier: BSD-3-Clause
// The loops of DiscSorter over discs; included only by the file that calls them.
#pragma once

#include <algorithm>
#include <array>

#include "cell_list/disc_sorter.hpp"
#include "cell_list/shared_work.hpp"

namespace carrom {

/// Prefetches discs that follow, further ahead than the processor itself does. Prefetching beyond
/// the last disc is harmless.
inline void prefetch(const DiscState& disc) {
    constexpr std::uintptr_t ahead = 32 * sizeof(DiscState);
    __builtin_prefetch(
        reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(&disc) + ahead));
}

/// Gives each thread a share of the discs, and the cells from its first cell to the next thread's
/// first cell. The first cell is the median cell of the share's first five discs, because a single
/// disc may have moved far.
template <class CellOf>
void DiscSorter::share_out(std::span<const DiscState> discs, const CellOf& find_cell,
                           std::uint32_t n_cells) {
    const std::size_t n_shares = sorters_.size();
    for (std::size_t k = 0; k < n_shares; ++k) {
        sorters_[k].strays.clear();
        sorters_[k].first_disc = share(n_discs_, k, n_shares);
        sorters_[k].end_disc = share(n_discs_, k + 1, n_shares);
    }
    sorters_[0].first_cell = 0;
    sorters_[n_shares - 1].end_cell = n_cells;
    for (std::size_t k = 1; k < n_shares; ++k) {
        std::array<std::uint32_t, 5> cells;
        cells.fill(n_cells);
        const auto first = discs.subspan(sorters_[k].first_disc);
        for (std::size_t i = 0; i < std::min(cells.size(), first.size()); ++i)
            cells[i] = find_cell(first[i]);
        std::ranges::sort(cells);
        sorters_[k].first_cell = std::max(sorters_[k - 1].first_cell, cells[2]);
        sorters_[k - 1].end_cell = sorters_[k].first_cell;
    }
}

/// Stores the cell of each disc of a share, and counts the discs that lie in the share's own cells.
template <class CellOf>
void DiscSorter::count_share(Sorter& mine, std::span<const DiscState> discs, const CellOf find_cell,
                             std::uint32_t* counts, Lent cell_of) {
    const std::uint32_t first = mine.first_cell, n_cells = mine.end_cell - first;
    const std::size_t end = mine.end_disc;
    std::fill_n(counts + first, n_cells, 0u);
    for (std::size_t i = mine.first_disc; i < end; ++i) {
        prefetch(discs[i]);
        const std::uint32_t cell = find_cell(discs[i]);
        cell_of.set(i, cell);
        if (cell - first < n_cells) [[likely]]
            ++counts[cell];
        else
            record(mine.strays, i);
    }
}

template <class CellOf>
void DiscSorter::find_order(std::span<const DiscState> discs, const CellOf& find_cell,
                            std::size_t n_columns, int n_threads,
                            RawVector<std::uint32_t>& cell_start, SortMemory memory) {
    begin(discs.size(), n_columns, n_threads);
    const auto n_cells = static_cast<std::uint32_t>(cell_start.size() - 1);
    // find_places replaces each count by the place of the next disc of the cell. When all discs
    // have places, this number is the place where the next cell begins.
    std::uint32_t* const counts = cell_start.data() + 1;
    cell_start.front() = 0;
    share_out(discs, find_cell, n_cells);
    if (n_threads == 1) {
        count_share(sorters_[0], discs, find_cell, counts, memory.cells());
    } else {
#pragma omp parallel for num_threads(n_threads) schedule(static, 1)
        for (std::size_t k = 0; k < sorters_.size(); ++k)
            count_share(sorters_[k], discs, find_cell, counts, memory.cells());
    }
    for (const Sorter& sorter : sorters_)
        are_in_disorder_ = are_in_disorder_ || sorter.strays.size() > most_travellers_;
    if (are_in_disorder_) share_out_equally(n_cells);
    find_places(counts, memory);
}

template <class Placed>
void DiscSorter::bring(std::span<DiscState> discs, SortMemory memory, const Placed& placed) {
    constexpr std::size_t ahead = 16;
    const Lent order = memory.order();
    const std::size_t n_shares = carriers_.size(), mask = n_passed_ - 1;
#pragma omp parallel for num_threads(n_threads_) schedule(static, 1)
    for (std::size_t k = 0; k < n_shares; ++k) {
        DiscState* const at = discs.data();
        DiscState* const passed = carriers_[k].passed.data();
        const DiscState* traveller = carriers_[k].travellers.data();
        const LocalIndex* arrival = carriers_[k].arrivals.data();
        const auto bring_to = [&](std::size_t i) {
            const std::size_t from = order[i];
            const DiscState* source = from >= i ? at + from : passed + (from & mask);
            if (i == *arrival) [[unlikely]] {
                source = traveller++;
                ++arrival;
            }
            if (source != at + i) {
                passed[i & mask] = at[i];
                at[i] = *source;
            }
            placed(i);
        };
        const std::size_t begin = share(n_discs_, k, n_shares),
                          end = share(n_discs_, k + 1, n_shares),
                          end_asking = end - std::min(ahead, end - begin);
        for (std::size_t i = begin; i < end_asking; ++i) {
            __builtin_prefetch(at + order[i + ahead]);
            bring_to(i);
        }
        for (std::size_t i = end_asking; i < end; ++i) bring_to(i);
    }
}

} // namespace carrom

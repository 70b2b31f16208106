// SPDX-License-Identifier: BSD-3-Clause
// The sorter's passes over discs, for the one file that calls them.
#pragma once

#include <algorithm>

#include "cell_list/disc_sorter.hpp"
#include "cell_list/shared_work.hpp"

namespace carrom {

/// Prefetches consecutive numbers, further ahead than the processor does by itself. Prefetching
/// beyond the last number is harmless.
inline void prefetch(const DiscState& disc) {
    constexpr std::uintptr_t ahead = 32 * sizeof(DiscState);
    __builtin_prefetch(
        reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(&disc) + ahead));
}

/// Counting sort by one thread. It reads states in the order in which they lie in memory.
template <class CellOf>
void DiscSorter::order_alone(std::span<const DiscState> discs, const CellOf& find_cell,
                             RawVector<std::uint32_t>& cell_start, SortMemory memory) {
    Lent cell_of = memory.cells(), order = memory.order();
    std::fill(cell_start.begin(), cell_start.end(), 0u);
    std::uint32_t* next = cell_start.data() + 1; // for each cell the number of its discs, later the
                                                 // place of its next disc
    for (std::size_t i = 0; i < discs.size(); ++i) {
        prefetch(discs[i]);
        const std::uint32_t cell = find_cell(discs[i]);
        cell_of.set(i, cell);
        ++next[cell];
    }
    std::uint32_t start = 0;
    for (std::size_t cell = 0; cell + 1 < cell_start.size(); ++cell) {
        const std::uint32_t count = next[cell];
        next[cell] = start;
        start += count;
    }
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const std::uint32_t place = next[cell_of[i]]++;
        order.set(place, static_cast<std::uint32_t>(i));
        if (i + n_passed_ <= place) record_traveller(carriers_[0], place);
    }
}

/// Stores each disc's cell, and records which cells each sorter meets.
template <class CellOf>
void DiscSorter::find_cells(std::span<const DiscState> discs, const CellOf& find_cell,
                            SortMemory memory) {
    Lent cell_of = memory.cells();
    share_out(discs.size(), static_cast<std::size_t>(n_threads_));
#pragma omp parallel for num_threads(n_threads_) schedule(static, 1)
    for (std::size_t k = 0; k < sorters_.size(); ++k) {
        Sorter& sorter = sorters_[k];
        std::uint32_t first = ~std::uint32_t{0}, last = 0;
        for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) {
            prefetch(discs[i]);
            const std::uint32_t cell = find_cell(discs[i]);
            cell_of.set(i, cell);
            first = std::min(first, cell);
            last = std::max(last, cell);
        }
        sorter.first_cell = std::min(first, last);
        sorter.end_cell = last + 1;
    }
}

/// Counting sort by several threads. Each sorter counts only between the first and the
/// last cell of its share of the discs. Shares are nearly in the order of their cells,
/// so all counts together are hardly more than the cells.
template <class CellOf>
void DiscSorter::order_together(std::span<const DiscState> discs, const CellOf& find_cell,
                                RawVector<std::uint32_t>& cell_start, SortMemory memory) {
    find_cells(discs, find_cell, memory);
    are_in_disorder_ = !make_room_for_counts(cell_start.size() - 1, memory);
    const Lent cell_of = memory.cells(), all_counts = memory.counts();
    Lent order = memory.order();
#pragma omp parallel for num_threads(n_threads_) schedule(static, 1)
    for (std::size_t k = 0; k < sorters_.size(); ++k) {
        const Sorter& sorter = sorters_[k];
        Lent counts = all_counts.from(sorter.counts);
        for (std::uint32_t cell = sorter.first_cell; cell < sorter.end_cell; ++cell)
            counts.set(cell - sorter.first_cell, 0);
        for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) {
            const std::uint32_t place = cell_of[i] - sorter.first_cell;
            counts.set(place, counts[place] + 1);
        }
    }
    turn_into_places(cell_start, all_counts);
#pragma omp parallel for num_threads(n_threads_) schedule(static, 1)
    for (std::size_t k = 0; k < sorters_.size(); ++k) {
        const Sorter& sorter = sorters_[k];
        Lent next = all_counts.from(sorter.counts);
        for (std::size_t i = sorter.first_disc; i < sorter.end_disc; ++i) {
            const std::uint32_t cell = cell_of[i] - sorter.first_cell, place = next[cell];
            next.set(cell, place + 1);
            order.set(place, static_cast<std::uint32_t>(i));
            const bool is_near = place >= sorter.first_disc && place < sorter.end_disc &&
                                 place < i + n_passed_;
            if (!is_near && !are_in_disorder_) record_traveller(carriers_[k], place);
        }
    }
    cell_start.back() = static_cast<std::uint32_t>(discs.size());
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

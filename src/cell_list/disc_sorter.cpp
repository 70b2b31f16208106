// SPDX-License-Identifier: BSD-3-Clause
#include "cell_list/disc_sorter.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "cell_list/shared_work.hpp"

namespace carrom {

void DiscSorter::begin(std::size_t n_discs, std::size_t n_columns, int n_threads) {
    n_discs_ = n_discs;
    constexpr std::size_t least_passed = 256, most_passed = 32768, columns_passed = 4;
    const std::size_t in_columns = columns_passed * n_discs_ / n_columns;
    n_passed_ = std::bit_ceil(std::clamp(in_columns, least_passed, most_passed));
    most_travellers_ = 4096 + n_discs_ / (64 * static_cast<std::size_t>(n_threads));
    are_in_disorder_ = false;
    n_threads_ = n_threads;
    carriers_.resize(static_cast<std::size_t>(n_threads));
    for (Carrier& carrier : carriers_) carrier.sent.clear();
}

void DiscSorter::share_out(std::size_t n_discs, std::size_t n_sorters) {
    sorters_.resize(n_sorters);
    for (std::size_t k = 0; k < n_sorters; ++k) {
        sorters_[k].first_disc = share(n_discs, k, n_sorters);
        sorters_[k].end_disc = share(n_discs, k + 1, n_sorters);
    }
}

bool DiscSorter::make_room_for_counts(std::size_t n_cells, SortMemory memory) {
    constexpr std::size_t most_counting_all = 4;
    const auto lay_out = [this] {
        std::size_t n_counts = 0;
        for (Sorter& sorter : sorters_) {
            sorter.counts = n_counts;
            n_counts += sorter.end_cell - sorter.first_cell;
        }
        return n_counts;
    };
    std::size_t n_counts = lay_out();
    const bool are_too_many = n_counts > most_counting_all * n_cells;
    if (are_too_many) {
        share_out(n_discs_, most_counting_all);
        for (Sorter& sorter : sorters_) {
            sorter.first_cell = 0;
            sorter.end_cell = static_cast<std::uint32_t>(n_cells);
        }
        n_counts = lay_out();
    }
    const std::size_t needed = 2 * memory.lane_length + n_counts;
    if (memory.lanes.size() < needed) memory.lanes.resize(needed);
    return !are_too_many;
}

/// Calls visit(cell, index of the count) for the counts of all sorters in the cells begin .. end,
/// cell by cell.
template <class Visit>
void DiscSorter::for_each_count(std::size_t begin, std::size_t end, const Visit& visit) const {
    std::vector<Sorter> here;
    for (const Sorter& sorter : sorters_)
        if (sorter.first_cell < end && sorter.end_cell > begin) here.push_back(sorter);
    const auto counts_in = [](const Sorter& sorter, std::size_t cell) {
        return sorter.first_cell <= cell && cell < sorter.end_cell;
    };
    for (std::size_t cell = begin;
         // Stops at the cell where another sorter begins or ends. Most cells have one sorter
         cell < end;) {
        std::size_t stretch_end = end;
        const Sorter* one = nullptr;
        std::size_t n_here = 0;
        for (const Sorter& sorter : here) {
            if (sorter.first_cell > cell)
                stretch_end = std::min<std::size_t>(stretch_end, sorter.first_cell);
            if (sorter.end_cell > cell)
                stretch_end = std::min<std::size_t>(stretch_end, sorter.end_cell);
            if (!counts_in(sorter, cell)) continue;
            one = &sorter;
            ++n_here;
        }
        if (n_here == 1) {
            for (std::size_t count = one->counts + (cell - one->first_cell); cell < stretch_end;
                 ++cell, ++count)
                visit(cell, count);
        }
        for (; cell < stretch_end; ++cell) {
            for (const Sorter& sorter : here)
                if (counts_in(sorter, cell))
                    visit(cell, sorter.counts + (cell - sorter.first_cell));
        }
    }
}

/// Replaces the sorters' counts by the places of their next discs.
void DiscSorter::turn_into_places(RawVector<std::uint32_t>& cell_start, Lent all_counts) {
    const std::size_t n_cells = cell_start.size() - 1;
    const auto n_shares = static_cast<std::size_t>(n_threads_);
    std::vector<std::uint32_t> starts(n_shares + 1, 0); // the first cells of the shares
#pragma omp parallel num_threads(n_threads_)
    {
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            std::uint32_t n_discs = 0;
            for_each_count(share(n_cells, k, n_shares), share(n_cells, k + 1, n_shares),
                           [&](std::size_t, std::size_t count) { n_discs += all_counts[count]; });
            starts[k + 1] = n_discs;
        }
#pragma omp single
        for (std::size_t k = 0; k < n_shares; ++k) starts[k + 1] += starts[k];
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            std::uint32_t start = starts[k];
            const std::size_t begin = share(n_cells, k, n_shares),
                              end = share(n_cells, k + 1, n_shares);
            std::size_t next = begin;
            for_each_count(begin, end, [&](std::size_t cell, std::size_t count) {
                while (next <= cell) cell_start[next++] = start;
                const std::uint32_t n = all_counts[count];
                all_counts.set(count, start);
                start += n;
            });
            while (next < end) cell_start[next++] = start;
        }
    }
}

bool DiscSorter::share_out_travellers() {
    std::vector<LocalIndex> all;
    for (const Carrier& carrier : carriers_) {
        if (carrier.sent.size() > most_travellers_) are_in_disorder_ = true;
        if (are_in_disorder_) return false;
        all.insert(all.end(), carrier.sent.begin(), carrier.sent.end());
    }
    std::sort(all.begin(), all.end());
    auto begin = all.begin();
    for (std::size_t k = 0; k < carriers_.size(); ++k) {
        const auto end = std::lower_bound(begin, all.end(),
                                          share(n_discs_, k + 1, carriers_.size()));
        carriers_[k].arrivals.assign(begin, end);
        carriers_[k].arrivals.push_back(std::numeric_limits<LocalIndex>::max());
        begin = end;
    }
    return true;
}

void DiscSorter::set_travellers_aside(std::span<const DiscState> discs, SortMemory memory) {
    const Lent order = memory.order();
#pragma omp parallel for num_threads(n_threads_) schedule(static, 1)
    for (std::size_t k = 0; k < carriers_.size(); ++k) {
        Carrier& carrier = carriers_[k];
        carrier.passed.resize(n_passed_);
        carrier.travellers.clear();
        carrier.travellers.reserve(carrier.arrivals.size());
        for (std::size_t j = 0; j + 1 < carrier.arrivals.size(); ++j)
            carrier.travellers.push_back(discs[order[carrier.arrivals[j]]]);
    }
}

void DiscSorter::rearrange(std::initializer_list<std::span<DiscState>> arrays, SortMemory memory) {
    RawVector<std::uint32_t> order(n_discs_);
    const Lent old_order = memory.order();
#pragma omp parallel for num_threads(n_threads_) schedule(static)
    for (std::size_t i = 0; i < n_discs_; ++i) order[i] = old_order[i];
    // The states are copied through the lanes, a quarter of each state at a time, so that no second
    // array of states is needed.
    constexpr std::size_t quarter = sizeof(DiscState) / 4;
    static_assert(quarter == 4 * sizeof(float));
    if (memory.lanes.size() < 4 * memory.lane_length) {
        RawVector<float>().swap(memory.lanes); // frees the old lanes before new ones are allocated
        memory.lanes.resize(4 * memory.lane_length);
    }
    auto* lent = reinterpret_cast<std::byte*>(memory.lanes.data());
    const auto n = static_cast<std::int64_t>(n_discs_);
    for (const std::span<DiscState> discs : arrays) {
        if (discs.empty()) continue;
        auto* states = reinterpret_cast<std::byte*>(discs.data());
#pragma omp parallel num_threads(n_threads_)
        for (std::size_t part = 0; part < 4; ++part) {
#pragma omp for schedule(static)
            for (std::int64_t k = 0; k < n; ++k) {
                const auto slot = static_cast<std::size_t>(k);
                std::memcpy(lent + slot * quarter,
                            states + order[slot] * sizeof(DiscState) + part * quarter, quarter);
            }
#pragma omp for schedule(static)
            for (std::int64_t k = 0; k < n; ++k) {
                const auto slot = static_cast<std::size_t>(k);
                std::memcpy(states + slot * sizeof(DiscState) + part * quarter,
                            lent + slot * quarter, quarter);
            }
        }
    }
}

} // namespace carrom

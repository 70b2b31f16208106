// SPDX-License-Identifier: BSD-3-Clause
#include "cell_list/disc_sorter.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

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
    sorters_.resize(static_cast<std::size_t>(n_threads));
    carriers_.resize(static_cast<std::size_t>(n_threads));
    for (Carrier& carrier : carriers_) carrier.sent.clear();
}

void DiscSorter::share_out_equally(std::uint32_t n_cells) {
    const std::size_t n_shares = sorters_.size();
    for (std::size_t k = 0; k < n_shares; ++k) {
        sorters_[k].first_cell = static_cast<std::uint32_t>(share(n_cells, k, n_shares));
        sorters_[k].end_cell = static_cast<std::uint32_t>(share(n_cells, k + 1, n_shares));
    }
}

/// Calls visit(disc, cell) for those discs of the share `home` that lie in cells of `mine`, in
/// ascending order.
template <class Visit>
[[gnu::noinline]] void DiscSorter::visit_discs(const Sorter& mine, const Sorter& home,
                                               const Lent cell_of, Visit visit) const {
    const std::size_t end = home.end_disc;
    if (&home == &mine && home.strays.empty() && !are_in_disorder_) {
        for (std::size_t disc = home.first_disc; disc < end; ++disc)
            visit(static_cast<LocalIndex>(disc), cell_of[disc]);
        return;
    }
    const std::uint32_t first_cell = mine.first_cell, n_cells = mine.end_cell - first_cell;
    const auto visit_one = [&](std::size_t disc) {
        const std::uint32_t cell = cell_of[disc];
        if (cell - first_cell < n_cells) visit(static_cast<LocalIndex>(disc), cell);
    };
    if (&home == &mine || are_in_disorder_)
        for (std::size_t disc = home.first_disc; disc < end; ++disc) visit_one(disc);
    else
        for (const LocalIndex disc : home.strays) visit_one(disc);
}

/// Adds the discs that `count_share` has left out to the counts, and returns the number of all
/// discs in the cells of `mine`.
std::uint32_t DiscSorter::count_rest(const Sorter& mine, std::uint32_t* counts,
                                     Lent cell_of) const {
    std::size_t n_discs = 0;
    if (are_in_disorder_)
        std::fill(counts + mine.first_cell, counts + mine.end_cell, 0u);
    else
        n_discs = mine.end_disc - mine.first_disc - mine.strays.size();
    for (const Sorter& home : sorters_) {
        if (&home == &mine && !are_in_disorder_) continue;
        visit_discs(mine, home, cell_of, [&](LocalIndex, std::uint32_t cell) {
            ++counts[cell];
            ++n_discs;
        });
    }
    return static_cast<std::uint32_t>(n_discs);
}

/// Returns a function that assigns the next place of a cell to a disc of the share `home`. The
/// function also lists the discs that move to another thread's share, or further than the ring
/// buffer reaches.
auto DiscSorter::place_giver(const Sorter& home, Carrier& carrier, std::uint32_t* counts,
                             SortMemory memory) const {
    const std::size_t first = home.first_disc, n_near = home.end_disc - first, n_passed = n_passed_;
    return
        [=, this, &carrier, order = memory.order()](LocalIndex disc, std::uint32_t cell) mutable {
            const std::uint32_t place = counts[cell]++;
            order.set(place, disc);
            if (place - first >= n_near || place >= disc + n_passed) [[unlikely]]
                record(carrier.sent, place);
        };
}

/// Writes the order of the discs, and replaces the count of each cell by the cell's end.
void DiscSorter::find_places(std::uint32_t* counts, SortMemory memory) {
    const Lent cell_of = memory.cells();
    const std::size_t n_shares = sorters_.size();
    std::vector<std::uint32_t> starts(n_shares + 1, 0); // first place of each share of cells
#pragma omp parallel num_threads(n_threads_)
    {
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k)
            starts[k + 1] = count_rest(sorters_[k], counts, cell_of);
#pragma omp single
        for (std::size_t k = 0; k < n_shares; ++k) starts[k + 1] += starts[k];
#pragma omp for schedule(static, 1)
        for (std::size_t k = 0; k < n_shares; ++k) {
            const Sorter& mine = sorters_[k];
            std::uint32_t start = starts[k];
            for (std::uint32_t cell = mine.first_cell; cell < mine.end_cell; ++cell) {
                const std::uint32_t n_discs = std::exchange(counts[cell], start);
                start += n_discs;
            }
            for (const Sorter& home : sorters_)
                visit_discs(mine, home, cell_of, place_giver(home, carriers_[k], counts, memory));
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

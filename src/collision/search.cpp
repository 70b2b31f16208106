// SPDX-License-Identifier: BSD-3-Clause
#include "carrom/collision/search.hpp"

#include <algorithm>

#include <omp.h>

#include "contact_filter.hpp"

namespace carrom {

namespace {

/// Discs looked at later whose flights are asked for now.
constexpr std::int64_t around_ahead = 4;

} // namespace

/// What rejects in single precision: pairs by distance, walls by the position at the window's end, in cells.
template <class Law> struct Search<Law>::Bounds {
    float touching_squared;
    float x_low, x_high, y_low, y_high;

    Bounds(const Law& law, const CellGrid& grid) : touching_squared(grid.touching_squared(law.diameter())) {
        const GridFrame& frame = grid.frame();
        const double margin = law.radius() * 1e-6 / frame.cell_width + 0x1p-18 * (std::max(frame.n_columns, frame.n_rows) + 8);
        const auto cells = [&](double length, double origin) { return (length - origin) / frame.cell_width; };
        const double high = law.box_size() - law.radius();
        x_low = static_cast<float>(cells(law.radius(), frame.x_low) + margin);
        x_high = static_cast<float>(cells(high, frame.x_low) - margin);
        y_low = static_cast<float>(cells(law.radius(), frame.y_low) + margin);
        y_high = static_cast<float>(cells(high, frame.y_low) - margin);
    }

    bool reaches_wall(const FlightLanes& lanes, std::uint32_t slot) const {
        const float x = lanes.x[slot] + lanes.vx[slot], y = lanes.y[slot] + lanes.vy[slot];
        return x < x_low || x > x_high || y < y_low || y > y_high;
    }
};

template <class Law>
Search<Law>::Search(const Law& law, int n_threads)
    : law_(law), n_threads_(n_threads), lists_(static_cast<std::size_t>(n_threads)) {}

template <class Law>
void Search<Law>::predict_all(const Population& population, const CellGrid& grid, const Window& window) {
    const Bounds bounds(law_, grid);
    const int n_columns = grid.frame().n_columns;
    const int chunk = std::max(1, n_columns / (16 * n_threads_));
#pragma omp parallel num_threads(n_threads_)
    {
        SearchLists& lists = lists_[static_cast<std::size_t>(omp_get_thread_num())];
        if (lists.by_micro.size() < static_cast<std::size_t>(window.n_micro)) {
            lists.by_micro.resize(static_cast<std::size_t>(window.n_micro));
        }
        for (std::vector<Candidate>& list : lists.by_micro) list.clear();
#pragma omp for schedule(dynamic, chunk)
        for (int column = 0; column < n_columns; ++column) {
            predict_column(population, grid, window, bounds, column, lists);
        }
    }
}

template <class Law>
void Search<Law>::predict_column(const Population& population, const CellGrid& grid, const Window& window,
                                 const Bounds& bounds, int column, SearchLists& lists) const {
    constexpr std::size_t ahead = 8; // states are far apart: ask for them early
    const std::span<const LocalIndex> order = grid.order();
    std::vector<SlotPair>& pairs = lists.pairs;
    const std::size_t n_pairs = filter_column(grid, column, bounds.touching_squared, pairs);
    for (std::size_t k = 0; k < n_pairs; ++k) {
        if (k + ahead < n_pairs) {
            __builtin_prefetch(&population.discs[order[pairs[k + ahead].first]]);
            __builtin_prefetch(&population.discs[order[pairs[k + ahead].second]]);
        }
        predict_pair(population, window, window.first_micro, order[pairs[k].first], order[pairs[k].second], lists);
    }
    const SlotRange slots = grid.run(column, 0, grid.frame().n_rows - 1);
    for (std::uint32_t slot = slots.begin; slot < slots.end; ++slot) {
        if (bounds.reaches_wall(grid.lanes(), slot)) {
            predict_wall(population, window, window.first_micro, order[slot], lists);
        }
    }
}

template <class Law>
void Search<Law>::predict_again(const Population& population, const CellGrid& grid, const Window& window, int from,
                                double reach, std::span<const LocalIndex> hit, std::span<const std::uint8_t> is_hit) {
    const Bounds bounds(law_, grid);
    // Two discs that touch are a diameter apart, and the other one is half a reach less a radius from its cell.
    const float half_reach = grid.cells_of(reach / 2 + law_.radius());
    const auto begin = static_cast<float>((from - window.begin()) / window.duration());
    const std::span<const LocalIndex> order = grid.order();
    const auto n_hit = static_cast<std::int64_t>(hit.size());
#pragma omp parallel num_threads(n_threads_) if (n_hit > 64)
    {
        SearchLists& lists = lists_[static_cast<std::size_t>(omp_get_thread_num())];
        std::vector<std::uint32_t>& partners = lists.partners;
#pragma omp for schedule(dynamic, 64)
        for (std::int64_t k = 0; k < n_hit; ++k) {
            // What a disc needs is spread over a dozen cache lines: ask for the cells first, then for the flights in them.
            if (k + 2 * around_ahead < n_hit) grid.prefetch_cells(hit[static_cast<std::size_t>(k + 2 * around_ahead)]);
            if (k + around_ahead < n_hit) grid.prefetch_flights(hit[static_cast<std::size_t>(k + around_ahead)]);
            const LocalIndex index = hit[static_cast<std::size_t>(k)];
            const std::size_t n_partners = filter_around(grid, index, begin, half_reach, bounds.touching_squared, partners);
            for (std::size_t n = 0; n < n_partners; ++n) __builtin_prefetch(&population.discs[order[partners[n]]]);
            for (std::size_t n = 0; n < n_partners; ++n) {
                const LocalIndex other = order[partners[n]];
                if (is_hit[other] != 0 && other < index) continue;
                predict_pair(population, window, from, index, other, lists);
            }
            if (bounds.reaches_wall(grid.lanes(), grid.slot_of(index))) {
                predict_wall(population, window, from, index, lists);
            }
        }
    }
}

template <class Law>
void Search<Law>::predict_pair(const Population& population, const Window& window, int from, LocalIndex a, LocalIndex b,
                               SearchLists& lists) const {
    if (a >= population.n_own && b >= population.n_own) return;
    const Disc& first = population.discs[a];
    const Disc& second = population.discs[b];
    const PairContact<double> contact = law_.contact(first, second);
    if (!contact.exists()) return;
    const int m = first_micro_step(contact, from, window.end_micro());
    if (m == window.end_micro()) return;
    const double t = in_step_time(contact, m);
    if (!window.holds(t)) return;
    Candidate candidate{t, a, b, first.version(), second.version()};
    if (second.id < first.id) {
        std::swap(candidate.p, candidate.q);
        std::swap(candidate.p_version, candidate.q_version);
    }
    lists.by_micro[static_cast<std::size_t>(m - window.first_micro)].push_back(candidate);
}

template <class Law>
void Search<Law>::predict_wall(const Population& population, const Window& window, int from, LocalIndex index,
                               SearchLists& lists) const {
    if (index >= population.n_own) return;
    const Disc& disc = population.discs[index];
    for (int m = from; m < window.end_micro(); ++m) {
        const double t = law_.wall_time(disc, m);
        if (t == Law::never) continue;
        if (window.holds(t)) {
            lists.by_micro[static_cast<std::size_t>(m - window.first_micro)].push_back({t, index, wall, disc.version(), 0});
        }
        return;
    }
}

template <class Law>
void Search<Law>::collect(const Population& population, const Window& window, int m, std::vector<Candidate>& live) {
    const auto bucket = static_cast<std::size_t>(m - window.first_micro);
    std::vector<std::size_t> ends(static_cast<std::size_t>(n_threads_) + 1, 0);
#pragma omp parallel num_threads(n_threads_)
    {
        const auto thread = static_cast<std::size_t>(omp_get_thread_num());
        std::vector<Candidate>& list = lists_[thread].by_micro[bucket];
        std::erase_if(list, [&](const Candidate& candidate) { return !is_current(candidate, population.discs); });
        ends[thread + 1] = list.size();
#pragma omp barrier
#pragma omp single
        {
            for (std::size_t t = 1; t < ends.size(); ++t) ends[t] += ends[t - 1];
            live.resize(ends.back());
        }
        std::copy(list.begin(), list.end(), live.begin() + static_cast<std::ptrdiff_t>(ends[thread]));
        list.clear();
    }
}

template <class Law> std::size_t Search<Law>::bytes() const {
    std::size_t total = 0;
    for (const SearchLists& lists : lists_) {
        for (const std::vector<Candidate>& list : lists.by_micro) total += list.capacity() * sizeof(Candidate);
        total += lists.pairs.capacity() * sizeof(SlotPair);
    }
    return total;
}

template class Search<PlainLaw>;

} // namespace carrom

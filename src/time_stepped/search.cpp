// SPDX-License-Identifier: BSD-3-Clause
#include "time_stepped/search.hpp"

#include <algorithm>
#include <utility>

#include <omp.h>

#include "cell_list/shared_work.hpp"
#include "core/stop_request.hpp"
#include "time_stepped/contact_filter.hpp"
#include "time_stepped/step_walls.hpp"

namespace carrom {

namespace {

/// Number of discs between the prefetch of the flights around a disc and the search around it.
constexpr std::size_t around_ahead = 4;
/// Number of discs whose partners are listed before their contacts are predicted.
constexpr std::size_t hits_per_batch = 128;
/// Number of pairs between the prefetch of states and their use. States of a pair are far apart in
/// memory.
constexpr std::size_t pairs_ahead = 8;
/// Number of pairs between two tests for a request to stop.
constexpr std::size_t pairs_between_checks = 65536;

/// Adds a candidate of micro-step m that was predicted from the states at the beginning of
/// micro-step `from`.
void add(SearchLists& lists, const Window& window, int from, int m, const Candidate& candidate) {
    lists.by_micro[static_cast<std::size_t>(m - window.first_micro)].add(
        candidate, window.state_after(from - 1));
}

void prefetch(std::span<const DiscState> discs, LocalIndex index) {
    __builtin_prefetch(&discs[index]);
}

/// Calls `judge` for each of the first n pairs. Some pairs earlier, calls `ask` for the same pair,
/// so that it can prefetch the pair's states. Ends early if a request to stop is overdue.
template <class Ask, class Judge>
void for_each_ahead(const std::vector<DiscPair>& pairs, std::size_t n, const Ask& ask,
                    const Judge& judge) {
    for (std::size_t k = 0; k < std::min(pairs_ahead, n); ++k) ask(pairs[k]);
    for (std::size_t k = 0; k < n && !is_stop_overdue();) {
        for (const std::size_t end = std::min(k + pairs_between_checks, n); k < end; ++k) {
            if (k + pairs_ahead < n) ask(pairs[k + pairs_ahead]);
            judge(pairs[k]);
        }
    }
}

} // namespace

void MicroStepList::add(const Candidate& candidate, WindowState seen) {
    if (sections.empty() || sections.back().seen != seen)
        sections.push_back({seen, candidates.size()});
    candidates.push_back(candidate);
}

void MicroStepList::drop_stale(std::span<const WindowState> states) {
    std::size_t n_left = 0;
    for (std::size_t k = 0; k < sections.size(); ++k) {
        const std::size_t end = k + 1 < sections.size() ? sections[k + 1].begin : candidates.size();
        for (std::size_t i = sections[k].begin; i < end; ++i)
            if (is_current(candidates[i], sections[k].seen, states))
                candidates[n_left++] = candidates[i];
    }
    candidates.resize(n_left);
    sections.clear();
}

/// Moves the list out, so that its memory is freed before later lists grow. The next window
/// allocates the list again.
Candidates SearchLists::take(std::size_t bucket, std::span<const WindowState> states) {
    MicroStepList& list = by_micro[bucket];
    most_candidates = std::max(most_candidates, list.candidates.size());
    list.drop_stale(states);
    return std::exchange(list.candidates, {});
}

/// Bounds that reject contacts in single precision: pairs by their distance, walls by the position
/// at the window's end. They are in cells, along the grid's axis (x) and across it.
template <class Dynamics> struct Search<Dynamics>::Bounds {
    float touching_squared, touching_large_squared; ///< the second one for pairs with a large disc
    float x_low, x_high, y_low, y_high;

    Bounds(const Dynamics& dynamics, const CellGrid& grid, double usual_radius)
        : touching_squared(grid.touching_squared(dynamics.search_diameter() -
                                                 2 * (dynamics.radius() - usual_radius))),
          touching_large_squared(grid.touching_squared(dynamics.search_diameter())) {
        const GridGeometry& geometry = grid.geometry();
        const double margin = usual_radius * 1e-6 / geometry.cell_width +
                              0x1p-18 * (std::max(geometry.n_columns, geometry.n_rows) + 8);
        const auto cells = [&](double length, double origin) {
            return (length - origin) / geometry.cell_width;
        };
        const double radius = usual_radius;
        const auto [length, height] = turned(geometry.axis, dynamics.box().x, dynamics.box().y);
        x_low = static_cast<float>(cells(radius, geometry.low) + margin);
        x_high = static_cast<float>(cells(length - radius, geometry.low) - margin);
        y_low = static_cast<float>(cells(radius, geometry.across_low) + margin);
        y_high = static_cast<float>(cells(height - radius, geometry.across_low) - margin);
    }

    bool reaches_wall(const FlightLanes& lanes, std::uint32_t slot) const {
        const float x = lanes.x[slot] + lanes.vx[slot], y = lanes.y[slot] + lanes.vy[slot];
        return x < x_low || x > x_high || y < y_low || y > y_high;
    }
};

template <class Dynamics>
Search<Dynamics>::Search(const Dynamics& dynamics, int n_threads, double usual_radius)
    : dynamics_(dynamics), n_threads_(n_threads), usual_radius_(usual_radius),
      lists_(static_cast<std::size_t>(n_threads)) {}

template <class Dynamics>
void Search<Dynamics>::list_large([[maybe_unused]] const Population& population,
                                  [[maybe_unused]] const CellGrid& grid) {
    if constexpr (Dynamics::has_species) {
        if (!(usual_radius_ < dynamics_.radius())) return;
        std::vector<LocalIndex> indices;
        for (std::size_t k = 0; k < population.discs.size(); ++k)
            if (dynamics_.species_table().of(population.discs[k].id).radius > usual_radius_)
                indices.push_back(static_cast<LocalIndex>(k));
        large_.assign(std::move(indices), grid);
    }
}

template <class Dynamics>
void Search<Dynamics>::predict_all(const Population& population, const CellGrid& grid,
                                   const Window& window, double reach) {
    const Bounds bounds(dynamics_, grid, usual_radius_);
    const int n_columns = grid.geometry().n_columns;
    SharedWork columns(grid.column_shares(n_threads_), std::max(1, n_columns / (16 * n_threads_)));
    const auto n_apart = dynamics_.has_pairs() ? static_cast<std::int64_t>(grid.apart().size()) : 0;
    const std::int64_t n_large = large_.size();
#pragma omp parallel num_threads(n_threads_)
    {
        SearchLists& lists = lists_[static_cast<std::size_t>(omp_get_thread_num())];
        lists.by_micro.resize(static_cast<std::size_t>(window.n_micro));
        for (MicroStepList& list : lists.by_micro) list.begin(lists.most_candidates);
        columns.run(omp_get_thread_num(), [&](std::int64_t column) {
            predict_column(population, grid, window, bounds, static_cast<int>(column), lists);
        });
#pragma omp for schedule(dynamic, 8)
        for (std::int64_t k = 0; k < n_apart + n_large; ++k) {
            if (k < n_apart)
                predict_apart(population, grid, window, bounds, reach,
                              static_cast<std::uint32_t>(k), lists);
            else
                predict_large(population, grid, window, bounds, reach,
                              static_cast<std::uint32_t>(k - n_apart), lists);
        }
    }
}

/// Inlined into the loops over pairs, because it is the innermost work of a search.
template <class Dynamics>
[[gnu::always_inline]] inline void Search<Dynamics>::predict_pair(const Population& population,
                                                                  const Window& window, int from,
                                                                  LocalIndex a, LocalIndex b,
                                                                  SearchLists& lists) const {
    if (a >= population.n_own && b >= population.n_own) return;
    const DiscState& first = population.discs[a];
    const DiscState& second = population.discs[b];
    const auto contact = dynamics_.contact(first, second, dynamics_.tolerance());
    if (!contact.exists()) return;
    const int m = first_micro_step(contact, from, window.end_micro());
    if (m == window.end_micro()) return;
    const double t = in_step_time(contact, m);
    if (!window.holds(t)) return;
    Candidate candidate{t, a, b};
    if (second.id < first.id) std::swap(candidate.p, candidate.q);
    add(lists, window, from, m, candidate);
}

template <class Dynamics>
void Search<Dynamics>::predict_column(const Population& population, const CellGrid& grid,
                                      const Window& window, const Bounds& bounds, int column,
                                      SearchLists& lists) const {
    if (is_stop_overdue()) return; // the engine will abandon the step
    lists.n_pairs = dynamics_.has_pairs()
                        ? filter_column(grid, column, bounds.touching_squared, lists.pairs)
                        : 0;
    for_each_ahead(
        lists.pairs, lists.n_pairs,
        [&](const DiscPair& pair) {
            prefetch(population.discs, pair.first);
            prefetch(population.discs, pair.second);
        },
        [&](const DiscPair& pair) {
            if (is_large(population.discs[pair.first]) || is_large(population.discs[pair.second]))
                return;
            predict_pair(population, window, window.first_micro, pair.first, pair.second, lists);
        });
    const SlotRange own = grid.run(column, 0, grid.geometry().n_rows - 1);
    for (LocalIndex index = own.begin; index < own.end; ++index) {
        const bool meets = bounds.reaches_wall(grid.lanes(), index) || dynamics_.has_fixed_bodies();
        if (meets && !is_large(population.discs[index]))
            predict_wall(population, window, window.first_micro, index, lists);
    }
}

/// Largest distance, in cells, from a disc's path to the cells of the discs of the usual radius
/// that it touches. When they touch, the distance between their centres is the sum of both radii,
/// and in a window the other disc flies at most half a reach minus its own radius.
template <class Dynamics>
float Search<Dynamics>::half_reach(const CellGrid& grid, double reach, double radius) const {
    return grid.cells_of(reach / 2 + radius + dynamics_.slack());
}

/// Predicts contacts of disc k of the list CellGrid::apart. Its partners are all discs in cells,
/// unless it is large, and all later discs of that list, unless both are large.
template <class Dynamics>
void Search<Dynamics>::predict_apart(const Population& population, const CellGrid& grid,
                                     const Window& window, const Bounds& bounds, double reach,
                                     std::uint32_t k, SearchLists& lists) const {
    const std::span<const LocalIndex> apart = grid.apart();
    const FlightLanes flights = grid.apart_lanes();
    const bool k_is_large = is_large(population.discs[apart[k]]);
    const float touching = large_.size() > 0 ? bounds.touching_large_squared
                                             : bounds.touching_squared;
    std::size_t n_others = 0;
    if (!k_is_large)
        n_others = filter_along(grid, flights, k, 0, half_reach(grid, reach, dynamics_.radius()),
                                touching, lists.pairs, 0);
    lists.n_pairs = filter_lanes(flights, k, flights,
                                 {k + 1, static_cast<std::uint32_t>(apart.size())}, touching,
                                 lists.pairs, n_others);
    for (std::size_t i = 0; i < lists.n_pairs; ++i) {
        const LocalIndex other = i < n_others ? lists.pairs[i].second
                                              : apart[lists.pairs[i].second];
        if (k_is_large && is_large(population.discs[other])) continue;
        predict_pair(population, window, window.first_micro, apart[k], other, lists);
    }
}

/// Predicts contacts of large disc k with walls, with all discs in cells that are not large, and
/// with all later large discs.
template <class Dynamics>
void Search<Dynamics>::predict_large(const Population& population, const CellGrid& grid,
                                     const Window& window, const Bounds& bounds, double reach,
                                     std::uint32_t k, SearchLists& lists) const {
    predict_wall(population, window, window.first_micro, large_.index(k), lists);
    if (!dynamics_.has_pairs()) return;
    const FlightLanes flights = large_.lanes();
    const std::size_t n_others = filter_along(grid, flights, k, 0,
                                              half_reach(grid, reach, dynamics_.radius()),
                                              bounds.touching_large_squared, lists.pairs, 0);
    lists.n_pairs = filter_lanes(flights, k, flights, {k + 1, large_.size()},
                                 bounds.touching_large_squared, lists.pairs, n_others);
    for (std::size_t i = 0; i < lists.n_pairs; ++i) {
        const std::uint32_t other = lists.pairs[i].second;
        if (i < n_others && is_large(population.discs[other])) continue;
        predict_pair(population, window, window.first_micro, large_.index(k),
                     i < n_others ? other : large_.index(other), lists);
    }
}

template <class Dynamics>
void Search<Dynamics>::predict_again(const Population& population, const CellGrid& grid,
                                     const Window& window, int from, double reach,
                                     std::span<const LocalIndex> hit,
                                     std::span<const WindowState> states) {
    const Bounds bounds(dynamics_, grid, usual_radius_);
    if (large_.size() > 0)
        for (const LocalIndex index : hit)
            if (index != wall_index && is_large(population.discs[index]))
                large_.update(index, grid);
    const auto begin = static_cast<float>((from - window.begin()) / window.duration());
    const auto n_batches = static_cast<std::int64_t>((hit.size() + hits_per_batch - 1) /
                                                     hits_per_batch);
    const WindowState now = window.state_after(from - 1);
    SharedWork batches(equal_shares(n_batches, n_threads_), 1);
#pragma omp parallel num_threads(n_threads_) if (n_batches > 1)
    {
        SearchLists& lists = lists_[static_cast<std::size_t>(omp_get_thread_num())];
        batches.run(omp_get_thread_num(), [&](std::int64_t k) {
            const std::size_t first = static_cast<std::size_t>(k) * hits_per_batch;
            const std::span<const LocalIndex> batch = hit.subspan(
                first, std::min(hits_per_batch, hit.size() - first));
            find_pairs_around(population, grid, bounds, begin, reach, batch, lists);
            for_each_ahead(
                lists.pairs, lists.n_pairs,
                [&](const DiscPair& pair) { prefetch(population.discs, pair.second); },
                [&](const DiscPair& pair) {
                    // If both discs were hit, the pair is listed twice, so only one of the two
                    // entries is predicted.
                    if (states[pair.second] != now || pair.first < pair.second)
                        predict_pair(population, window, from, pair.first, pair.second, lists);
                });
            for (const LocalIndex index : batch) {
                if (index < population.n_own &&
                    (bounds.reaches_wall(grid.lanes(), index) || dynamics_.has_fixed_bodies() ||
                     is_large(population.discs[index])))
                    predict_wall(population, window, from, index, lists);
            }
        });
    }
}

/// Fills `lists.pairs` with pairs of each disc of `hit` and a disc that it might touch.
template <class Dynamics>
void Search<Dynamics>::find_pairs_around(const Population& population, const CellGrid& grid,
                                         const Bounds& bounds, float from, double reach,
                                         std::span<const LocalIndex> hit,
                                         SearchLists& lists) const {
    lists.n_pairs = 0;
    const float half = half_reach(grid, reach, usual_radius_);
    for (std::size_t k = 0; k < hit.size() && dynamics_.has_pairs(); ++k) {
        // The search around a disc reads a dozen cache lines, so the disc's cells are prefetched
        // first, and then the flights in them.
        if (k + 2 * around_ahead < hit.size()) grid.prefetch_cells(hit[k + 2 * around_ahead]);
        if (k + around_ahead < hit.size()) grid.prefetch_flights(hit[k + around_ahead]);
        if (hit[k] == wall_index) continue;
        if (Dynamics::has_species && large_.size() > 0)
            find_pairs_with_large(population, grid, bounds, from, reach, hit[k], lists);
        else
            lists.n_pairs = filter_around(grid, hit[k], from, half, bounds.touching_squared,
                                          lists.pairs, lists.n_pairs);
    }
}

/// Appends the pairs of a disc that was hit, if there are large discs. Large partners are searched
/// in their own list, all others in cells.
template <class Dynamics>
void Search<Dynamics>::find_pairs_with_large(const Population& population, const CellGrid& grid,
                                             const Bounds& bounds, float from, double reach,
                                             LocalIndex index, SearchLists& lists) const {
    const bool its_large = is_large(population.discs[index]), is_own = index < grid.n_own();
    const FlightLanes lanes = is_own ? grid.lanes() : grid.halo_lanes();
    const std::uint32_t slot = is_own ? index : grid.halo_slot(index);
    const std::size_t first = lists.n_pairs;
    const std::size_t n_in_cells = filter_around(
        grid, index, from, half_reach(grid, reach, its_large ? dynamics_.radius() : usual_radius_),
        its_large ? bounds.touching_large_squared : bounds.touching_squared, lists.pairs, first);
    const std::size_t n_all = filter_lanes(lanes, slot, large_.lanes(), {0, large_.size()},
                                           bounds.touching_large_squared, lists.pairs, n_in_cells);
    for (std::size_t i = first; i < n_all; ++i) {
        LocalIndex other = lists.pairs[i].second;
        if (i >= n_in_cells)
            other = large_.index(other);
        else if (is_large(population.discs[other]))
            continue;
        if (other != index) lists.pairs[lists.n_pairs++] = {index, other};
    }
}

template <class Dynamics>
void Search<Dynamics>::predict_wall(const Population& population, const Window& window, int from,
                                    LocalIndex index, SearchLists& lists) const {
    if (index >= population.n_own) return;
    const DiscState& disc = population.discs[index];
    for (int m = from; m < window.end_micro(); ++m) {
        const double t = StepWalls(dynamics_).time(disc, m);
        if (t == never) continue;
        if (window.holds(t)) add(lists, window, from, m, {t, index, wall_index});
        return;
    }
}

template <class Dynamics>
Candidates Search<Dynamics>::collect(const Window& window, int m,
                                     std::span<const WindowState> states) {
    const auto bucket = static_cast<std::size_t>(m - window.first_micro);
    if (n_threads_ == 1) return lists_[0].take(bucket, states);
    Candidates live;
    std::vector<std::size_t> ends(static_cast<std::size_t>(n_threads_) + 1, 0);
#pragma omp parallel num_threads(n_threads_)
    {
        const auto thread = static_cast<std::size_t>(omp_get_thread_num());
        const Candidates own = lists_[thread].take(bucket, states);
        ends[thread + 1] = own.size();
#pragma omp barrier
#pragma omp single
        {
            for (std::size_t t = 1; t < ends.size(); ++t) ends[t] += ends[t - 1];
            live.resize(ends.back());
        }
        std::ranges::copy(own, live.data() + ends[thread]);
    }
    return live;
}

#define CARROM_DEFINE(Dynamics) template class Search<Dynamics>;
CARROM_FOR_EACH_DYNAMICS(CARROM_DEFINE)
#undef CARROM_DEFINE

} // namespace carrom

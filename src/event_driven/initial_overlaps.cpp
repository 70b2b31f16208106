// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/initial_overlaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "engine/near_pairs.hpp"

namespace carrom {

namespace {

constexpr std::size_t n_named = 5;

struct Overlap {
    DiscId p = ~DiscId{0}, q = ~DiscId{0};
    double depth = 0;

    friend bool operator<(const Overlap& a, const Overlap& b) {
        return a.p != b.p ? a.p < b.p : a.q < b.q;
    }
};

/// The first overlapping pairs of a rank, or of all ranks. `number` also counts pairs that are not
/// listed.
struct FirstOverlaps {
    std::uint64_t number = 0;
    std::array<Overlap, n_named> pairs; ///< in ascending order; empty entries come last

    void add(const Overlap& overlap) {
        ++number;
        if (!(overlap < pairs.back())) return;
        pairs.back() = overlap;
        std::sort(pairs.begin(), pairs.end());
    }
    FirstOverlaps& operator+=(const FirstOverlaps& part) {
        const std::uint64_t sum = number + part.number;
        for (const Overlap& overlap : part.pairs)
            if (overlap.depth > 0) add(overlap);
        number = sum;
        return *this;
    }
};

#pragma omp declare reduction(+ : FirstOverlaps : omp_out += omp_in)

} // namespace

void refuse_overlaps(const Population& population, const CellGrid& grid, double time,
                     const Touching& touching, const Communicator& communicator, int n_threads,
                     const std::string& scene_name) {
    FirstOverlaps mine;
    const int n_columns = grid.geometry().n_columns;
#pragma omp parallel for num_threads(n_threads) schedule(dynamic, 8) reduction(+ : mine)
    for (int column = 0; column < n_columns; ++column) {
        visit_near_pairs_of(grid, column, [&](LocalIndex a, LocalIndex b) {
            if (population.discs[b].id < population.discs[a].id) std::swap(a, b);
            if (a >= population.n_own) return; // the owner of the lower id counts the pair
            const DiscState& p = population.discs[a];
            const DiscState& q = population.discs[b];
            const Shift shift = touching.periods.between(p, q, time);
            const double dx = (q.x_at(time) - p.x_at(time)) + shift.x;
            const double dy = (q.y_at(time) - p.y_at(time)) + shift.y;
            const double depth = touching.diameter_of(p, q) - std::sqrt(dx * dx + dy * dy);
            if (depth > 2 * touching.tolerance) mine.add({p.id, q.id, depth});
        });
    }
    FirstOverlaps all;
    for (const FirstOverlaps& part : communicator.all_gather(mine)) all += part;
    if (all.number == 0) return;
    std::string pairs;
    for (const Overlap& overlap : all.pairs) {
        if (overlap.depth > 0)
            pairs += fmt::format("{}{} and {} (by {:.3g})", pairs.empty() ? "" : ", ", overlap.p,
                                 overlap.q, overlap.depth);
    }
    throw InputError(
        {{scene_name, 0,
          fmt::format(
              "{} of discs overlap: {}{}; method = \"event-driven\" needs discs that do not",
              all.number == 1 ? "1 pair" : fmt::format("{} pairs", all.number), pairs,
              all.number > n_named ? ", ..." : "")}});
}

} // namespace carrom

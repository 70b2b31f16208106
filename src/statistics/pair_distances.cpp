// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/pair_distances.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/near_pairs.hpp"

namespace carrom {

namespace {

std::size_t species_of(DiscId id, std::span<const DiscId> species_ends) {
    std::size_t k = 0;
    while (id >= species_ends[k]) ++k;
    return k;
}

} // namespace

void count_pair_distances(const LocalView& local_view, double bin_width,
                          std::span<const DiscId> species_ends, int n_threads,
                          std::span<std::uint64_t> counts) {
    const Population& population = local_view.population;
    const std::size_t n_each = counts.size() / n_pair_kinds(species_ends.size());
    const double bins_per_length = 1 / bin_width, n_bins = static_cast<double>(n_each);
    const bool are_alike = species_ends.size() == 1;
    const int n_columns = local_view.grid->geometry().n_columns;
#pragma omp parallel num_threads(n_threads)
    {
        std::vector<std::uint64_t> mine(counts.size(), 0);
#pragma omp for schedule(dynamic, 1)
        for (int column = 0; column < n_columns; ++column) {
            visit_near_pairs_of(*local_view.grid, column, [&](LocalIndex a, LocalIndex b) {
                // The lower id comes first, so that the difference has the same bits on every rank,
                // in any order of its discs.
                if (population.discs[b].id < population.discs[a].id) std::swap(a, b);
                if (a >= population.n_own) return; // the owner of the lower id counts the pair
                const DiscState &p = population.discs[a], &q = population.discs[b];
                const Shift shift = local_view.periods.between(p, q, local_view.time);
                const double dx = (q.x_at(local_view.time) - p.x_at(local_view.time)) + shift.x,
                             dy = (q.y_at(local_view.time) - p.y_at(local_view.time)) + shift.y;
                const double bin = std::sqrt(dx * dx + dy * dy) * bins_per_length;
                if (!(bin < n_bins)) return;
                const std::size_t kind = are_alike ? 0
                                                   : pair_kind(species_of(p.id, species_ends),
                                                               species_of(q.id, species_ends));
                ++mine[kind * n_each + static_cast<std::size_t>(bin)];
            });
        }
#pragma omp critical(pair_distances)
        for (std::size_t k = 0; k < counts.size(); ++k) counts[k] += mine[k];
    }
}

double share_of_ideal_pairs(double a, double b, double distance) {
    const double r = distance;
    return 4 / (a * a * b * b) * r * r *
           (a * b * (0.25 * std::numbers::pi) - (a + b) * r / 3 + r * r / 8);
}

double share_of_ideal_pairs_around_x(double period, double b, double distance) {
    const double r = distance;
    return r * r / (period * b * b) * (std::numbers::pi * b - 4 * r / 3);
}

double share_of_ideal_pairs_around(double area, double distance) {
    return std::numbers::pi * distance * distance / area;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
#include "statistics/pair_distances.hpp"

#include <algorithm>
#include <array>
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

/// Gauss-Legendre quadrature with five points: the weight of the middle point, then the other
/// points and their weights.
constexpr double middle_weight = 128.0 / 225;
constexpr std::array<std::array<double, 2>, 2> nodes = {
    {{0.5384693101056831, 0.47862867049936647}, {0.9061798459386640, 0.23692688505618908}}};

template <class What> double integral(double low, double high, int n_parts, const What& what) {
    const double half = (high - low) / (2 * n_parts);
    double sum = 0;
    for (int k = 0; k < n_parts; ++k) {
        const double middle = low + half * (2 * k + 1);
        sum += middle_weight * what(middle);
        for (const auto& [node, weight] : nodes)
            sum += weight * (what(middle - half * node) + what(middle + half * node));
    }
    return half * sum;
}

/// A stadium along x, centred at the origin; its straight sides extend from -straight to straight.
struct Stadium {
    double straight, radius;

    double area() const { return (std::numbers::pi * radius + 4 * straight) * radius; }
    /// Half of the chord along y.
    double half_chord(double x) const {
        const double beyond = std::max(std::fabs(x) - straight, 0.0);
        return std::sqrt(std::max(radius * radius - beyond * beyond, 0.0));
    }
    /// The area that the stadium shares with a copy whose centre is at (p, q), with p, q >= 0. The
    /// common part is symmetric about its middle; left of that the copy has the shorter chords.
    double common_area(double p, double q) const {
        const auto chord = [&](double x, double half) { // x is relative to the copy's centre
            return std::clamp(half_chord(x + p) + half - q, 0.0, 2 * half);
        };
        constexpr int n_parts = 24;
        const double end = std::max(p / 2 - straight, 0.0) / radius;
        double area = end < 1
                          ? integral(
                                std::asin(end), std::numbers::pi / 2, n_parts,
                                [&](double angle) {
                                    const double half = radius * std::cos(angle);
                                    return half * chord(-straight - radius * std::sin(angle), half);
                                })
                          : 0;
        if (p / 2 < straight)
            area += integral(-straight, -p / 2, n_parts,
                             [&](double x) { return chord(x, radius); });
        return 2 * area;
    }
};

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

double share_of_ideal_pairs_in_circle(double radius, double distance) {
    const double s = std::min(distance / (2 * radius), 1.0), root = std::sqrt(1 - s * s);
    return 1 +
           (2 * (4 * s * s - 1) * std::acos(s) - 2 * s * (1 + 2 * s * s) * root) / std::numbers::pi;
}

/// For a pair with the difference h, the positions of one point form the common part of the stadium
/// and its copy shifted by h. All four quadrants of h contribute equally.
double share_of_ideal_pairs_in_stadium(double length, double radius, double inner, double outer) {
    const Stadium stadium{length / 2, radius};
    const double pairs = integral(inner, outer, 2, [&](double distance) {
        return distance * integral(0, std::numbers::pi / 2, 6, [&](double angle) {
                   return stadium.common_area(distance * std::cos(angle),
                                              distance * std::sin(angle));
               });
    });
    return 4 * pairs / (stadium.area() * stadium.area());
}

} // namespace carrom

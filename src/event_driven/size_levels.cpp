// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/size_levels.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

namespace {

// Costs in instructions, for vectors of eight lanes.
constexpr double cost_per_level = 80;  ///< cost for each level that a search visits
constexpr double cost_per_column = 50; ///< cost for each column of cells that the search covers
constexpr double cost_per_partner = 4; ///< cost for each disc in these cells
constexpr int n_octaves = 48;          ///< octaves of radii that can have levels of their own

/// Typical length of a disc's flight in a window, in mean distances between discs
constexpr double flight = 0.5;

/// The mean cost of a search. Levels are weighted by their estimated collision rates.
double cost_of(std::span<const SizeLevel> levels, double area, double travel) {
    double cost = 0, n_all = 0;
    for (const SizeLevel& own : levels) n_all += own.n_discs * own.largest_radius;
    for (const SizeLevel& own : levels) {
        const double share = own.n_discs * own.largest_radius / n_all;
        for (const SizeLevel& other : levels) {
            const double reach = 2 * (other.largest_radius + travel),
                         spacing = std::sqrt(area / other.n_discs),
                         width = std::max(std::min(reach, 2 * spacing), reach / 4),
                         side = 2 * (own.largest_radius + other.largest_radius + travel) + width;
            cost += share * (cost_per_level + cost_per_column * side / width +
                             cost_per_partner * other.n_discs * side * side / area);
        }
    }
    return cost;
}

} // namespace

std::vector<SizeLevel> choose_size_levels(std::span<const Species> species, double radius,
                                          double n_discs, double area, bool is_each_octave) {
    if (species.empty()) return {{radius, radius, n_discs, n_discs * radius}};
    double largest = 0;
    for (const Species& one : species) largest = std::max(largest, one.radius);
    std::vector<SizeLevel> levels(n_octaves);
    for (const Species& one : species) {
        const double octaves = std::floor(std::log2(largest / one.radius));
        const auto level = static_cast<std::size_t>(
            std::clamp(n_octaves - 1 - octaves, 0.0, n_octaves - 1.0));
        SizeLevel& it = levels[level];
        it.largest_radius = std::max(it.largest_radius, one.radius);
        it.smallest_radius = it.n_discs > 0 ? std::min(it.smallest_radius, one.radius) : one.radius;
        it.n_discs += static_cast<double>(one.count);
        it.sum_of_radii += static_cast<double>(one.count) * one.radius;
    }
    std::erase_if(levels, [](const SizeLevel& level) { return level.n_discs == 0; });
    if (is_each_octave) return levels;
    const double travel = flight * std::sqrt(area / n_discs);
    double least = cost_of(levels, area, travel);
    // merges neighbouring levels as long as that saves time
    for (bool has_merged = true; has_merged;) {
        has_merged = false;
        for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
            std::vector<SizeLevel> fewer = levels;
            fewer[k + 1].n_discs += fewer[k].n_discs;
            fewer[k + 1].sum_of_radii += fewer[k].sum_of_radii;
            fewer[k + 1].smallest_radius = fewer[k].smallest_radius;
            fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
            const double cost = cost_of(fewer, area, travel);
            if (cost > least) continue;
            least = cost;
            levels = std::move(fewer);
            has_merged = true;
            break;
        }
    }
    return levels;
}

double equivalent_radius(std::span<const SizeLevel> levels) {
    if (levels.size() == 1 && levels[0].smallest_radius == levels[0].largest_radius)
        return levels[0].largest_radius;
    double sum = 0, n = 0;
    for (const SizeLevel& level : levels) { // mean of a disc's radius and its level's largest
        sum += (level.sum_of_radii + level.n_discs * level.largest_radius) / 2;
        n += level.n_discs;
    }
    return sum / n;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Counts pairs of discs by distance, each pair on one rank.
#pragma once

#include <cstdint>
#include <span>

#include "engine/engine.hpp"

namespace carrom {

/// The number of kinds of pairs of `n_species` species, in the order (0, 0), (0, 1), (1, 1), (0, 2)
/// and so on.
constexpr std::size_t n_pair_kinds(std::size_t n_species) {
    return n_species * (n_species + 1) / 2;
}
constexpr std::size_t pair_kind(std::size_t a, std::size_t b) {
    return n_pair_kinds(a < b ? b : a) + (a < b ? a : b);
}

/// Adds to counts[k] this rank's pairs whose distance is k to k + 1 times `bin_width`. The view
/// must include partners up to the largest distance. `species_ends` are the ids before which
/// species end; the last one is N. The counts of each kind of pair follow each other.
/// Counts are whole numbers, so threads and ranks may add in any order.
void count_pair_distances(const LocalView& local_view, double bin_width,
                          std::span<const DiscId> species_ends, int n_threads,
                          std::span<std::uint64_t> counts);

/// The share of "ideal pairs", which are pairs of independent points, in a box of a by b that are
/// at most `distance` apart, up to the shorter side. (From the distribution of each component's
/// difference, as in Ghosh, Bull. Calcutta Math. Soc. 43, 17 (1951).)
double share_of_ideal_pairs(double a, double b, double distance);
/// The share of ideal pairs in a box with periodic sides and walls along the side b, for nearest
/// images, up to half a period.
double share_of_ideal_pairs_around_x(double period, double b, double distance);
/// The share of ideal pairs in a box without walls, for nearest images.
double share_of_ideal_pairs_around(double area, double distance);
/// The share of ideal pairs in a circle, up to its diameter (Hammersley, Ann. Math. Stat. 21, 447
/// (1950)).
double share_of_ideal_pairs_in_circle(double radius, double distance);
/// The share of ideal pairs whose distance is from `inner` to `outer` in a stadium: two half
/// circles joined by straight sides of `length`. The relative error is 1e-5 for narrow bins.
double share_of_ideal_pairs_in_stadium(double length, double radius, double inner, double outer);

} // namespace carrom

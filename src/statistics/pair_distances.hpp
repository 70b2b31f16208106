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
/// species end; the last one is N. `counts` has all bins of one kind of pair, then those of the
/// next. Counts are whole numbers, so threads and ranks may add in any order.
void count_pair_distances(const LocalView& local_view, double bin_width,
                          std::span<const DiscId> species_ends, int n_threads,
                          std::span<std::uint64_t> counts);

/// "Ideal pairs" are pairs of independent points with equal probability everywhere in the box. This
/// is the share of ideal pairs that are at most `distance` apart in a box of a by b; the distance
/// must not exceed the shorter side. (From the distribution of each component's difference, as in
/// Ghosh, Bull. Calcutta Math. Soc. 43, 17 (1951).)
double share_of_ideal_pairs(double a, double b, double distance);
/// The same share in a box that is periodic along x, with nearest images, and has walls a length b
/// apart; for distances up to half a period and up to b.
double share_of_ideal_pairs_around_x(double period, double b, double distance);
/// This share in a box that is periodic along both axes, with distances to nearest images; for
/// distances up to half the shorter period.
double share_of_ideal_pairs_around(double area, double distance);
/// The same share in a circle, for distances up to its diameter (Hammersley, Ann. Math. Stat. 21,
/// 447 (1950)).
double share_of_ideal_pairs_in_circle(double radius, double distance);
/// The share of ideal pairs whose distance is from `inner` to `outer` in a stadium: two half
/// circles joined by straight sides of `length`. The relative error is 1e-5 for narrow bins.
double share_of_ideal_pairs_in_stadium(double length, double radius, double inner, double outer);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Statistics of all discs of a system at its present step, on all ranks: sums of motion, pairs by
// distance, and psi6. The module `statistics` has the arithmetic; these functions give it the discs
// that it needs, and add ranks up. All have the same bits on any number of ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bond_order.hpp"
#include "simulation/disc_system.hpp"
#include "statistics/hexatic_order.hpp"
#include "statistics/motion.hpp"

namespace carrom {

/// The sums from which averages follow, without the integrals of stress and energy. **Collective.**
MotionSample motion_sample(const DiscSystem& system);
/// Adds these integrals, where `mine` are this rank's sums of the time that counts. **Collective.**
void integrate(const DiscSystem& system, const StressSums& mine, MotionSample& sample);
/// Adds those over flights since the last sync alone, which are no part of the sums yet.
void integrate_flights(const DiscSystem& system, MotionSample& sample);

/// Adds to counts[k] this rank's pairs of discs at distances from k to k + 1 times `bin_width`,
/// now; over all ranks each pair is counted once. The counts of all bins reach no further than
/// half the box. `species_ends`: the ids before which species end, the last one the number of
/// discs. As many counts follow each other for pairs of species (0, 0), (0, 1), (1, 1), (0, 2)
/// and so on. **Collective.**
void count_pair_distances(DiscSystem& system, double bin_width,
                          std::span<const DiscId> species_ends, std::span<std::uint64_t> counts);

/// psi6 of all discs together, and of their pairs up to that distance, of all ranks.
/// **Collective.**
HexaticSums hexatic_order(DiscSystem& system, double largest_distance, std::size_t n_bins);
/// psi6 of no more than `most_discs` discs, evenly spread over the ids, without pairs.
/// **Collective.**
HexaticSums sampled_order(DiscSystem& system, std::uint64_t most_discs);
/// psi6 of each of the own discs, along `DiscSystem::discs` as they lie then: this moves them in
/// memory. **Collective.**
std::vector<BondOrder> bond_orders(DiscSystem& system);

} // namespace carrom

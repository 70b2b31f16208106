// SPDX-License-Identifier: BSD-3-Clause
// Statistics of all discs of a system at its present step, on all ranks: sums of motion, and pairs
// by distance. The module `statistics` contains the arithmetic; these functions provide the discs
// for it, and add the results of all ranks. All results have the same bits on any number of ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "simulation/disc_system.hpp"
#include "statistics/motion.hpp"

namespace carrom {

/// Sums over all discs for averages, without the integrals of stress and energy. **Collective.**
MotionSample motion_sample(const DiscSystem& system);
/// Adds the integrals of stress and energy over an interval; `mine` are this rank's sums over it.
/// **Collective.**
void integrate(const DiscSystem& system, const StressSums& mine, MotionSample& sample);
/// Adds to `sample` only the flights that DiscSystem::stress_sums lacks (Engine::flight_integral).
void integrate_flights(const DiscSystem& system, MotionSample& sample);

/// Adds to counts[k] this rank's pairs of discs whose present distance is k to k + 1 times
/// `bin_width`; over all ranks each pair is counted once. All bins must lie within half the box.
/// `species_ends`: the end of each species' range of ids; the last one is the number of discs. The
/// counts of pairs of species (0, 0), (0, 1), (1, 1), (0, 2) and so on follow each other.
/// **Collective.**
void count_pair_distances(DiscSystem& system, double bin_width,
                          std::span<const DiscId> species_ends, std::span<std::uint64_t> counts);

} // namespace carrom

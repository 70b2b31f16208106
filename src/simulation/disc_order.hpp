// SPDX-License-Identifier: BSD-3-Clause
// The hexatic order of the discs of a system at its present step, from their Voronoi neighbours on
// all ranks. The module `statistics` contains the arithmetic; these functions provide the discs for
// it, and add the results of all ranks. All results have the same bits on any number of ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/computed_fields.hpp"
#include "simulation/disc_system.hpp"
#include "statistics/hexatic_order.hpp"

namespace carrom {

/// psi6 of all discs together, and correlations of pairs up to `largest_distance`, over all ranks.
/// **Collective.**
HexaticSums hexatic_order(DiscSystem& system, double largest_distance, std::size_t n_bins);
/// psi6 of at most `most_discs` discs, evenly spread over the ids, without pairs. **Collective.**
HexaticSums sampled_order(DiscSystem& system, std::uint64_t most_discs);
/// psi6 of each own disc, in the order of `DiscSystem::discs` after the call, which moves the discs
/// in memory. **Collective.**
std::vector<BondOrder> bond_orders(DiscSystem& system);
/// The numbers of computed_fields.hpp for each own disc; 0 for discs without a Voronoi cell, such
/// as departed ones. Moves and orders the discs like `bond_orders`. **Collective.**
std::vector<ComputedNumbers> computed_numbers(DiscSystem& system);

} // namespace carrom

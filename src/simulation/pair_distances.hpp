// SPDX-License-Identifier: BSD-3-Clause
// How many pairs of discs are how far apart, each pair counted by one rank.
#pragma once

#include <cstdint>
#include <span>

#include "engine.hpp"

namespace carrom {

/// Adds to counts[k] this rank's pairs at a distance from k to k + 1 times `bin_width`; the discs are settled for partners
/// that far. Counts are whole numbers: threads and ranks may add in any order.
void count_pair_distances(const Settled& settled, double bin_width, int n_threads, std::span<std::uint64_t> counts);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The own and halo discs of a rank, for searches and measurements.
#pragma once

#include <cstddef>
#include <span>

#include "core/disc_state.hpp"

namespace carrom {

/// The own discs of a rank, then the halo. Pairs of two halo discs are left to other ranks.
struct Population {
    std::span<const DiscState> discs;
    std::size_t n_own = 0;
};

} // namespace carrom

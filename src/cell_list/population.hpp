// SPDX-License-Identifier: BSD-3-Clause
// A rank's discs, its own and its halo's, as searches and measurements see them.
#pragma once

#include <cstddef>
#include <span>

#include "core/disc_state.hpp"

namespace carrom {

/// A rank's discs: its own first, then the halo's. Other ranks treat the pairs of two
/// halo discs.
struct Population {
    std::span<const DiscState> discs;
    std::size_t n_own = 0;
};

} // namespace carrom

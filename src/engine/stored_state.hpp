// SPDX-License-Identifier: BSD-3-Clause
// The state that a run begins from or goes on from.
#pragma once

#include <cstdint>
#include <vector>

#include "core/disc.hpp"

namespace carrom {

/// What a run can be continued from: discs as they are stored at the end of a step (velocities per
/// micro-step, times since the last sync), and how many micro-steps since the scene's start have
/// led there.
struct StoredState {
    std::vector<Disc> discs;
    std::int64_t micro_steps_done = 0;
    std::vector<double> spins{}; ///< along the discs, of rough ones; empty: no disc turns yet
};

} // namespace carrom

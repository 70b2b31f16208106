// SPDX-License-Identifier: BSD-3-Clause
// The state from which a run starts or restarts.
#pragma once

#include <cstdint>
#include <vector>

#include "core/disc_state.hpp"
#include "core/side_columns.hpp"

namespace carrom {

/// Discs as they are stored at the end of a step: velocities per micro-step, times since the last
/// sync. `micro_steps_done` counts from the scene's start.
struct StoredState {
    DiscStates discs;
    std::int64_t micro_steps_done = 0;
    SideColumns columns{}; ///< values in the order of the discs; columns left out are 0
    /// Values that effects keep from one sync to the next (SyncEffect::kept); equal on all ranks.
    std::vector<std::int64_t> kept_by_effects{};
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The state from which a run starts or restarts.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/disc_state.hpp"
#include "core/side_columns.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Discs as they are stored at the end of a step: velocities per micro-step, times since the last
/// sync. `micro_steps_done` counts from the scene's start.
struct StoredState {
    DiscStates discs;
    std::int64_t micro_steps_done = 0;
    SideColumns columns{}; ///< values in the order of the discs; a missing column counts as 0
    /// Values that effects keep from one sync to the next (SyncEffect::kept); equal on all ranks.
    std::vector<std::int64_t> kept_by_effects{};
};

/// Moves out of `state` the side columns that are sent with the discs, including those that no
/// collision changes.
template <class Dynamics>
SideColumns stored_columns(const Dynamics& dynamics, const SceneParameters& scene,
                           StoredState& state) {
    SideColumnSet wanted = side_columns_of(dynamics).present();
    side_columns_of(scene).for_each([&](SideColumn column) { wanted.add(column); });
    SideColumns columns;
    wanted.for_each(
        [&](SideColumn column) { columns.add(column, std::move(state.columns[column])); });
    return columns;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The start of a run: the discs of its scene, or the contents of a checkpoint.
#pragma once

#include <optional>
#include <vector>

#include "core/stored_samples.hpp"
#include "engine/stored_state.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Discs are in any distribution over the ranks.
struct RunStart {
    std::vector<InputDisc> discs{};      ///< for a run from step 0
    std::optional<StoredState> stored{}; ///< the state that a restart goes on from
    StoredSamples samples{};             ///< the measurements that it goes on with
    bool counts_images = false;          ///< also where no trajectory shows them
};

} // namespace carrom

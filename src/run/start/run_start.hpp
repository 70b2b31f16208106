// SPDX-License-Identifier: BSD-3-Clause
// The start of a run: the discs of its scene, or the contents of a checkpoint.
#pragma once

#include <optional>
#include <vector>

#include "core/stored_samples.hpp"
#include "engine/stored_state.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Each rank has some of the discs, in any distribution.
struct RunStart {
    std::vector<InputDisc> discs{};      ///< initial discs of a run from step 0
    std::optional<StoredState> stored{}; ///< the state from which a restart continues
    StoredSamples samples{};             ///< the measurements that a restart continues
    bool counts_images = false;          ///< count images even if no trajectory contains them
};

} // namespace carrom

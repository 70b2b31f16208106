// SPDX-License-Identifier: BSD-3-Clause
// Counts discs by speed, so that windows can be chosen.
#pragma once

#include <span>

#include "core/disc_state.hpp"
#include "engine/window_choice.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// `largest_speed` > 0 is the largest speed on all ranks. **Collective.**
SpeedSpread survey_speeds(std::span<const DiscState> own, double largest_speed,
                          const Communicator& communicator, int n_threads);

} // namespace carrom

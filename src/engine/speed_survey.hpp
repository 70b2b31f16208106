// SPDX-License-Identifier: BSD-3-Clause
// Counts discs by speed, so that windows can be chosen.
#pragma once

#include <span>

#include "core/disc_state.hpp"
#include "engine/window_choice.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Counts discs of all ranks by speed; the largest speed is `largest_speed` > 0. **Collective.**
SpeedSpread survey_speeds(std::span<const DiscState> own, double largest_speed,
                          const Communicator& communicator, int n_threads);

} // namespace carrom

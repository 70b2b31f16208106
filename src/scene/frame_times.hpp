// SPDX-License-Identifier: BSD-3-Clause
// The steps that have a frame in a trajectory: step 0, and then regular ones, or ones that grow by
// a factor, because a slow liquid has something to show in each decade of time.
#pragma once

#include <cstdint>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// The first step after `step` that has a frame; the largest number there is if none has.
std::int64_t next_frame(const TrajectoryOutput& output, std::int64_t step);
/// The last step up to `step`, from 0 on, that has a frame.
std::int64_t last_frame(const TrajectoryOutput& output, std::int64_t step);

} // namespace carrom

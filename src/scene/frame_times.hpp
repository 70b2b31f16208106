// SPDX-License-Identifier: BSD-3-Clause
// The steps that have a frame in a trajectory: step 0, and then steps at equal distances, or steps
// that grow by a constant factor, which suit slow liquids that change in each decade of time.
#pragma once

#include <cstdint>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// The first step after `step` that has a frame; the largest possible number if there is none.
std::int64_t next_frame(const TrajectoryOutput& output, std::int64_t step);
/// The last step from 0 to `step` that has a frame.
std::int64_t last_frame(const TrajectoryOutput& output, std::int64_t step);

} // namespace carrom

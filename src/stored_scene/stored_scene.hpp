// SPDX-License-Identifier: BSD-3-Clause
// A scene as files keep it: in the header of a checkpoint, and in a recording of its run. The text
// and the settings on top of it are stored, so a file alone is enough to go on.
#pragma once

#include <string>
#include <vector>

#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

/// The header of a checkpoint of the present step. Not collective.
CheckpointHeader header_now(const Scene& scene, const Simulation& simulation);

/// The scene of a file, with more settings (`key=value`) on top. Throws InputError.
Scene scene_of(const CheckpointHeader& header, const std::vector<std::string>& more_overrides);

/// Throws InputError where going on from the checkpoint would make the scene another run; `place`
/// names the checkpoint in its problems.
void refuse_other_run(const CheckpointHeader& header, const Scene& scene, const std::string& place);

/// How a recorded run differs from that of the scene: the first difference in words, or nothing.
std::string first_difference(const CheckpointHeader& there, const Scene& scene);

/// What files of the scene's run say of its discs.
RecordedSystem system_of(const Scene& scene);
/// What a trajectory of the scene's run holds.
TrajectoryLayout layout_of(const Scene& scene, const TrajectoryOutput& wanted);

} // namespace carrom

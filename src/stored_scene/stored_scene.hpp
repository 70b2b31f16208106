// SPDX-License-Identifier: BSD-3-Clause
// Stores the scene in files: in headers of checkpoints and in recordings of its run. The text and
// its overrides (`key=value`) are stored, so the file alone is enough to continue the run.
#pragma once

#include <string>
#include <vector>

#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The header of a checkpoint that is written at the system's present step. Not collective.
CheckpointHeader header_now(const SceneParameters& scene, const DiscSystem& system);

/// The scene stored in a file, with more settings (`key=value`) on top. Throws InputError.
SceneParameters scene_of(const CheckpointHeader& header,
                         const std::vector<std::string>& more_overrides);

/// Throws InputError if the checkpoint belongs to another run than the scene; `place` names the
/// checkpoint in the message.
void refuse_other_run(const CheckpointHeader& header, const SceneParameters& scene,
                      const std::string& place);

/// The first difference between a recorded run and the scene's run; empty if there is none.
std::string first_difference(const CheckpointHeader& there, const SceneParameters& scene);

/// The description of the box and the discs that files of the scene's run contain.
RecordedSystem system_of(const SceneParameters& scene);
/// The contents of the trajectory file of the scene's run, with the fields that `wanted` lists.
TrajectoryLayout layout_of(const SceneParameters& scene, const TrajectoryOutput& wanted);

} // namespace carrom

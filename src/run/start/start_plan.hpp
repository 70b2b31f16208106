// SPDX-License-Identifier: BSD-3-Clause
// The plan of how a run begins: its scene, and whether it continues from a checkpoint. The plan
// follows from options, the scene's text and the names of files. Planning generates no discs, and
// leaves no new file or lock. load.hpp carries out the plan.
//
// Rank 0 reads the scene and broadcasts its text, so all ranks find the same scene or the same
// problems. No output of the run has been written when a problem is printed.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"
#include "run/files/destinations.hpp"
#include "run/start/restart.hpp"
#include "run/start/run_options.hpp"
#include "run/start/scene_source.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct StartPlan {
    /// If the run was killed before its first checkpoint, `input` is the copy of the scene in the
    /// run's folder
    RunOptions options;
    /// The scene of the input; without an input, the checkpoint's scene later replaces it
    SceneParameters scene{};
    SceneSource source{}; ///< the rest of the input after the scene's text
    RestartPlan restart{};

    bool has_scene() const { return !options.input.empty(); }
};

/// Throws InputError on every rank with `problems` (found so far, the same on all ranks), and with
/// problems of the paths in options, of the scene and of its outputs' paths. If there are none, it
/// throws the problems of finding a checkpoint. **Collective.**
StartPlan plan_start(const RunOptions& options, const std::vector<Problem>& problems,
                     const Communicator& ranks);

/// Describes the plan, line by line.
std::string text_of(const StartPlan& plan);

/// Returns only the scene; throws the problems of its text and its outputs' paths. Creates no
/// folder and takes no lock. **Collective.**
SceneParameters load_scene_alone(const RunOptions& options, const std::vector<Problem>& problems,
                                 const Communicator& ranks);

/// Adds the problem if a scene that writes files has no folder to write to.
void check_folder(const SceneParameters& scene, std::vector<Problem>& problems);

/// The files that the options name as outputs. They are checked before the run, so that writing
/// them does not fail at its end, and does not overwrite its input.
std::vector<Destination> outputs_named_by(const RunOptions& options);
/// The files that the run reads, which must not be outputs.
std::vector<NamedFile> files_read_for(const RunOptions& options, const SceneParameters& scene);

} // namespace carrom

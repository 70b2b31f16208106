// SPDX-License-Identifier: BSD-3-Clause
// The plan of how a run begins: its scene, and whether it goes on from a checkpoint. It follows
// from options, the scene's text and the names of files; no disc is read, nothing is made or
// locked. load.hpp carries it out.
//
// Rank 0 opens files and reads; the others get its bytes, so all ranks find the same scene
// or the same problems. No output of the run has been written when a problem is printed.
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
    RunOptions options;      ///< the copy of the scene in the run's folder is their input, if the
                             ///< run was killed before its first checkpoint
    SceneParameters scene{}; ///< of the input; if there is none, that of the checkpoint will be
    SceneSource source{};    ///< the input behind the scene's text
    RestartPlan restart{};

    bool has_scene() const { return !options.input.empty(); }
};

/// Throws InputError on every rank with `problems` (found so far, the same on all
/// ranks), those of the paths that options name, and those of the scene and its outputs' places; if
/// there are none, with those of where to look for a checkpoint. **Collective.**
StartPlan plan_start(const RunOptions& options, const std::vector<Problem>& problems,
                     const Communicator& ranks);

/// The plan in words, line by line.
std::string text_of(const StartPlan& plan);

/// Returns the scene alone; finds the problems of its text and its outputs' places.
/// Makes and locks nothing. **Collective.**
SceneParameters load_scene_alone(const RunOptions& options, const std::vector<Problem>& problems,
                                 const Communicator& ranks);

/// A run writes into one folder: the problem if a scene that writes files has none.
void check_folder(const SceneParameters& scene, std::vector<Problem>& problems);

/// Files that the options name. They are checked because a run must not end in a file
/// that cannot be written, nor empty its own input.
std::vector<Destination> outputs_named_by(const RunOptions& options);
/// The files that are read; outputs must be others.
std::vector<NamedFile> files_read_for(const RunOptions& options, const SceneParameters& scene);

} // namespace carrom

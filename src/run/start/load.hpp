// SPDX-License-Identifier: BSD-3-Clause
// From the options of a run to its scene and first discs. All errors of the input show here.
//
// Rank 0 opens files and reads; the others get its bytes, so all ranks find the same scene
// or the same problems. No output of the run has been written when a problem is printed.
#pragma once

#include <vector>

#include "core/errors.hpp"
#include "io/write_lock.hpp"
#include "parallel/communicator.hpp"
#include "run/start/run_options.hpp"
#include "run/start/run_start.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// A scene and where its run starts.
struct Loaded {
    SceneParameters scene;
    RunStart start;
    std::vector<WriteLock> locks; ///< rank 0's, on all outputs
};

/// Throws InputError on every rank with `problems` (found so far, the same on all
/// ranks), those of the report's path and those of the scene. If there are none, with
/// those of the outputs' places, of the lines of discs, or of the checkpoint to go on
/// from. Rank 0 prints the scene's warnings. **Collective.**
Loaded load(const RunOptions& options, const std::vector<Problem>& problems,
            const Communicator& ranks);

/// Returns the scene alone; finds the problems of its text and its outputs' places.
/// Makes and locks nothing. **Collective.**
SceneParameters load_scene_alone(const RunOptions& options, const std::vector<Problem>& problems,
                                 const Communicator& ranks);

} // namespace carrom

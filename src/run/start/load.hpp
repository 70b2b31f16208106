// SPDX-License-Identifier: BSD-3-Clause
// Carries out the plan of how a run begins: reads the checkpoint, or reads or generates the initial
// discs, and claims the outputs. All errors of the input are found here or while planning.
#pragma once

#include <vector>

#include "core/errors.hpp"
#include "io/write_lock.hpp"
#include "parallel/communicator.hpp"
#include "run/start/run_options.hpp"
#include "run/start/run_start.hpp"
#include "run/start/start_plan.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// A scene and where its run starts.
struct Loaded {
    SceneParameters scene;
    RunStart start;
    std::vector<WriteLock> locks; ///< rank 0's lock of the output folder, if there is one
};

/// Throws InputError on every rank with the problems of the checkpoint, of the outputs' paths, or
/// of the lines of discs. Rank 0 prints the scene's warnings. **Collective.**
Loaded carry_out(StartPlan plan, const Communicator& ranks);

/// Plans the start of a run, and carries the plan out. **Collective.**
inline Loaded load(const RunOptions& options, const std::vector<Problem>& problems,
                   const Communicator& ranks) {
    return carry_out(plan_start(options, problems, ranks), ranks);
}

} // namespace carrom

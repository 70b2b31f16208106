// SPDX-License-Identifier: BSD-3-Clause
// Restarts from a checkpoint. The plan records where to search for checkpoints, and which ones
// exist. It is made from options and the names of files alone. `read_restart` reads the newest of
// these files that is undamaged and belongs to the scene's run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/checkpoint.hpp"
#include "parallel/communicator.hpp"
#include "run/start/run_options.hpp"
#include "run/start/run_start.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// The source of a run's first state; the same on every rank.
struct RestartPlan {
    enum class From {
        scene,     ///< the run starts at step 0
        file,      ///< the checkpoint that an option names
        folder,    ///< the newest checkpoint of the folder that an option names
        own_folder ///< the newest checkpoint of the run's own folder; without one the run starts
                   ///< at step 0
    };
    From from = From::scene;
    std::string place{}; ///< path of the file or the folder
    /// The file, or the checkpoints of the folder, newest first
    std::vector<std::string> candidates{};

    bool goes_on() const { return from != From::scene; }
};

/// Makes the plan from options and the names in the folder; `scene` is the scene of the input, if
/// there is one. Opens no file. Throws on every rank (exit code 2) if no folder is known, or if it
/// cannot be listed. **Collective.**
RestartPlan plan_restart(const RunOptions& options, const SceneParameters& scene,
                         const Communicator& ranks);

/// Lists the folder again and updates the plan. Returns whether the checkpoints have changed.
/// **Collective.**
bool has_other_checkpoints(RestartPlan& plan, const Communicator& ranks);

/// Reads the plan's newest checkpoint that is undamaged and of the scene's run. Rank 0 reports why
/// it skips others. Without an input, `scene` becomes the checkpoint's scene with the overrides of
/// the options. Returns nothing if the run starts at step 0. Throws on every rank (exit code 2) if
/// a named file, or all checkpoints of a folder, are unusable, if a named folder has none, if there
/// is no checkpoint and no input, or if the checkpoint is later than the run's last step.
/// **Collective.**
std::optional<RunStart> read_restart(const RestartPlan& plan, const RunOptions& options,
                                     SceneParameters& scene, const Communicator& ranks);

/// The start of a run that continues from the checkpoint.
RunStart start_of(Checkpoint checkpoint);

/// Call it when the folder is locked and no checkpoint was found. Prints that the run starts at
/// step 0. Throws on every rank (exit code 2) if that would replace recordings of later steps.
/// **Collective.**
void begin_anew(const RestartPlan& plan, const RunOptions& options, const SceneParameters& scene,
                const Communicator& ranks);

/// The paths of undamaged checkpoints in a folder that belong to the scene's run and are of steps
/// before `step`, oldest first. **Collective.**
std::vector<std::string> earlier_checkpoints(const std::string& folder,
                                             const SceneParameters& scene, std::int64_t step,
                                             const Communicator& ranks);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Going on from a checkpoint. A plan says where it is looked for, and which files are there; it is
// made of options and names of files alone. Another function reads the newest of these files that
// is undamaged and of the run that the scene describes.
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

/// Where a run's first state comes from; the same on every rank.
struct RestartPlan {
    enum class From {
        scene,     ///< the run begins at its start
        file,      ///< a checkpoint that was named
        folder,    ///< the newest checkpoint of a folder that was named
        own_folder ///< the newest of the run's own folder; without one the run begins at its start
    };
    From from = From::scene;
    std::string place{};                   ///< the file or the folder
    std::vector<std::string> candidates{}; ///< the file, or a folder's checkpoints, newest first

    bool goes_on() const { return from != From::scene; }
};

/// Looks at options and folder; `scene` is that of the input, if there is one. Opens no file.
/// Throws on every rank (exit code 2) if no folder is known, or if it cannot be listed.
/// **Collective.**
RestartPlan plan_restart(const RunOptions& options, const SceneParameters& scene,
                         const Communicator& ranks);

/// Lists the folder again. Returns whether it has other checkpoints than the plan, which has them
/// then. **Collective.**
bool has_other_checkpoints(RestartPlan& plan, const Communicator& ranks);

/// Reads the newest undamaged checkpoint of the plan; rank 0 reports why it passes over others. If
/// no input was named, `scene` becomes that of the checkpoint with the options' overrides on top.
/// Returns nothing if the run begins at its start. Throws on every rank (exit code 2) if a named
/// file is damaged, if a named folder has no checkpoint, if all of a folder are damaged, or if the
/// scene would be another run. **Collective.**
std::optional<RunStart> read_restart(const RestartPlan& plan, const RunOptions& options,
                                     SceneParameters& scene, const Communicator& ranks);

/// The start of a run that goes on from the checkpoint.
RunStart start_of(Checkpoint checkpoint);

/// Called if nothing was found and the folder is locked: prints that the run begins at
/// step 0. Throws on every rank (exit code 2) if that would replace what a run has
/// recorded after its start. **Collective.**
void begin_anew(const RestartPlan& plan, const RunOptions& options, const SceneParameters& scene,
                const Communicator& ranks);

/// Undamaged checkpoints in a folder that are of the scene's run and of earlier steps
/// than `step`, oldest first. **Collective.**
std::vector<std::string> earlier_checkpoints(const std::string& folder,
                                             const SceneParameters& scene, std::int64_t step,
                                             const Communicator& ranks);

} // namespace carrom

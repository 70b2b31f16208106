// SPDX-License-Identifier: BSD-3-Clause
// Going on from a checkpoint: finds the file, and checks that it is undamaged and of
// the run that the scene describes.
#pragma once

#include <string>
#include <vector>

#include "io/checkpoint.hpp"
#include "parallel/communicator.hpp"
#include "run/start/load.hpp"
#include "run/start/run_options.hpp"

namespace carrom {

/// Fills in `loaded.stored` and, if no input was named, the scene of the checkpoint
/// with the options' overrides on top. From a folder it takes the newest undamaged
/// checkpoint; rank 0 reports why it passes over others. If a run's own folder has
/// none, `stored` stays empty, and the run begins at its start. Throws on every rank
/// (exit code 2) if a named file is damaged, if a named folder has no checkpoint, if
/// all of a folder are damaged, if a folder cannot be listed, or if the scene would be
/// another run. **Collective.**
void load_restart(const RunOptions& options, Loaded& loaded, const Communicator& ranks);

/// The start of a run that goes on from the checkpoint.
RunStart start_of(Checkpoint checkpoint);

/// Called if nothing was found and the folder is locked: prints that the run begins at
/// step 0. Throws on every rank (exit code 2) if that would replace what a run has
/// recorded after its start. **Collective.**
void begin_anew(const RunOptions& options, const SceneParameters& scene, const Communicator& ranks);

/// The checkpoints to choose from, newest first; none if the options name a file. **Collective.**
std::vector<std::string> restart_candidates(const RunOptions& options, const SceneParameters& scene,
                                            const Communicator& ranks);

/// Undamaged checkpoints in a folder that are of the scene's run and of earlier steps
/// than `step`, oldest first. **Collective.**
std::vector<std::string> earlier_checkpoints(const std::string& folder,
                                             const SceneParameters& scene, std::int64_t step,
                                             const Communicator& ranks);

} // namespace carrom

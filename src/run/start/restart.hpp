// SPDX-License-Identifier: BSD-3-Clause
// Going on from a checkpoint: which file, whether it is whole, and whether it is of the run that
// the scene describes.
#pragma once

#include <string>
#include <vector>

#include "io/checkpoint.hpp"
#include "parallel/communicator.hpp"
#include "run/start/load.hpp"
#include "run/start/run_options.hpp"

namespace carrom {

/// Fills in `loaded.stored` and, where no input was named, the scene that the checkpoint carries,
/// with the options' overrides on top. Of a folder the newest whole checkpoint is taken; rank 0
/// says why others are passed over. A run's own folder without any leaves `stored` empty: the run
/// begins at its start. Throws on every rank (exit code 2) if a named file is damaged, if a named
/// folder has no checkpoint, if none of a folder is whole, if a folder cannot be listed, or if the
/// scene would be another run.
/// **Collective.**
void load_restart(const RunOptions& options, Loaded& loaded, const Communicator& ranks);

/// To be called when nothing was found and the folder is locked: prints that the run begins at step
/// 0. Throws on every rank (exit code 2) if that would replace what a run has recorded beyond its
/// start. **Collective.**
void begin_anew(const RunOptions& options, const Scene& scene, const Communicator& ranks);

/// What it chooses from, newest first; nothing where the options name a file. **Collective.**
std::vector<std::string> restart_candidates(const RunOptions& options, const Scene& scene,
                                            const Communicator& ranks);

/// Whole checkpoints of the scene's run in a folder that are of earlier steps than `step`, oldest
/// first. **Collective.**
std::vector<std::string> earlier_checkpoints(const std::string& folder, const Scene& scene,
                                             std::int64_t step, const Communicator& ranks);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Going on from a checkpoint: which file, whether it is whole, and whether it is of the run that
// the scene describes.
#pragma once

#include <string>
#include <vector>

#include "apps/load.hpp"
#include "apps/run_options.hpp"
#include "io/checkpoint.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// Fills in `loaded.stored` and, where no input was named, the scene that the checkpoint carries,
/// with the options' overrides on top. Of a folder the newest whole checkpoint is taken; rank 0
/// says why others are passed over. A folder without any leaves `stored` empty: the run begins at
/// its start. Throws on every rank (exit code 2) if a named file is damaged, if no checkpoint of a
/// folder is whole, or if the scene would be another run. **Collective.**
void load_restart(const RunOptions& options, Loaded& loaded, const Communicator& ranks);

/// What it chooses from, newest first; nothing where the options name a file. **Collective.**
std::vector<std::string> restart_candidates(const RunOptions& options, const Scene& scene,
                                            const Communicator& ranks);

/// Whole checkpoints of the scene's run in its folder that are of earlier steps than `step`, oldest
/// first. **Collective.**
std::vector<std::string> earlier_checkpoints(const Scene& scene, std::int64_t step,
                                             const Communicator& ranks);

/// Whole checkpoints in the scene's folder, of steps from `first` on.
struct OlderCheckpoints {
    using Other = std::pair<std::string, std::string>; ///< path, and what differs from the scene
    std::vector<Other> of_others;                      ///< up to `last`
    std::vector<Other> later_others;                   ///< beyond
    std::int64_t last_own = -1; ///< the latest step, up to `last`, of the scene's own run
};
/// **Collective.**
OlderCheckpoints older_checkpoints(const Scene& scene, std::int64_t first, std::int64_t last,
                                   const Communicator& ranks);

} // namespace carrom

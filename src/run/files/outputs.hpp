// SPDX-License-Identifier: BSD-3-Clause
// Checks before a run begins: its outputs can be written, are none of the files that it reads, and
// belong to no other run; and no other run is writing there now.
#pragma once

#include <string>
#include <vector>

#include "core/write_problem.hpp"
#include "io/write_lock.hpp"
#include "parallel/communicator.hpp"
#include "run/files/destinations.hpp"
#include "run/start/run_options.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Problems of paths to write to. `failures` are problems of the disk or of rights, where the path
/// itself may be correct.
struct PlaceProblems {
    std::vector<Problem> problems, failures;

    /// Adds the problem, if there is one; `key` is the key or option that sets `path`.
    void note(const std::string& key, const std::string& path, const WriteProblem& found);
    std::vector<Problem> all() const;
    /// Throws with code 2 if there are problems, with code 4 if there are only
    /// failures. **Collective.**
    void agree(const Communicator& ranks) const;
};

/// Throws InputError on every rank if the run cannot use its folder, or if it would write to
/// `sources`, which are read, or twice to one path; `others` are its other outputs. Throws
/// CollectiveError, code 4, if the paths are correct but the disk fails. Makes the folder. The
/// locks of rank 0 must live as long as the run writes. **Collective.**
std::vector<WriteLock> claim_outputs(const RunOptions& options, const SceneParameters& scene,
                                     const std::vector<NamedFile>& sources,
                                     const std::vector<Destination>& others,
                                     const Communicator& ranks);

/// The problems of the outputs of a run that cannot begin for other reasons, so that all problems
/// are printed together. Makes and locks nothing.
std::vector<Problem> problems_of_outputs(const RunOptions& options, const SceneParameters& scene,
                                         const std::vector<NamedFile>& sources);

/// Prepares the folder of a run that will certainly begin. If the run starts at step 0, older files
/// of a run in the folder are removed. **Collective.**
void prepare_outputs(const SceneParameters& scene, bool begins_anew, const Communicator& ranks);

} // namespace carrom

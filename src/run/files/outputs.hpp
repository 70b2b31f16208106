// SPDX-License-Identifier: BSD-3-Clause
// Checks before a run begins that its outputs can be written, are not among the files that it
// reads, and do not belong to another run, and that no other run is writing to its folder.
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

/// Problems of output paths. `failures` are problems of the disk or of permissions, where the path
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

/// Throws InputError on every rank if the run cannot use its folder, or if an output path is among
/// `sources`, which are read, or occurs twice. `others` are the outputs outside of the folder.
/// Throws CollectiveError, code 4, if the paths are correct but the disk fails. Creates the folder.
/// The locks, which rank 0 gets, must live as long as the run writes. **Collective.**
std::vector<WriteLock> claim_outputs(const RunOptions& options, const SceneParameters& scene,
                                     const std::vector<NamedFile>& sources,
                                     const std::vector<Destination>& others,
                                     const Communicator& ranks);

/// Checks the output paths of a run that is already known to fail, so that all problems are printed
/// together. Creates no folder and takes no lock.
std::vector<Problem> problems_of_outputs(const RunOptions& options, const SceneParameters& scene,
                                         const std::vector<NamedFile>& sources);

/// Prepares the folder of a run that will certainly begin. If the run starts at step 0, older files
/// of a run in the folder are removed. **Collective.**
void prepare_outputs(const SceneParameters& scene, bool begins_anew, const Communicator& ranks);

} // namespace carrom

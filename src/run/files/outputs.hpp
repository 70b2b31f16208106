// SPDX-License-Identifier: BSD-3-Clause
// Before a run begins: that what it wants to write can be written, is nothing that is read or
// belongs to another run, and that no other run is writing there now.
#pragma once

#include <string>
#include <vector>

#include "core/write_problem.hpp"
#include "io/write_lock.hpp"
#include "parallel/communicator.hpp"
#include "run/files/destinations.hpp"
#include "run/start/run_options.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// What is wrong with places to write to: `failures` are those of disks and rights, where the place
/// could be right.
struct PlaceProblems {
    std::vector<Problem> problems, failures;

    /// Adds what was found, if anything; `key` is what names the path.
    void note(const std::string& key, const std::string& path, const WriteProblem& found);
    std::vector<Problem> all() const;
    /// Ends with code 2 where there are problems, with code 4 where there are only failures.
    /// **Collective.**
    void agree(const Communicator& ranks) const;
};

/// Throws InputError on every rank where the run cannot have its folder, or where it would write to
/// `sources`, files that are read, or to one place twice; `others` is what else is written.
/// CollectiveError, code 4, where the place is right and the disk refuses. Makes the folder. Rank
/// 0's lock must live as long as the run writes. **Collective.**
std::vector<WriteLock> claim_outputs(const RunOptions& options, const Scene& scene,
                                     const std::vector<NamedFile>& sources,
                                     const std::vector<NamedFile>& others,
                                     const Communicator& ranks);

/// The same for a run that will not begin, so that all is printed at once: makes nothing, locks
/// nothing.
std::vector<Problem> problems_of_outputs(const RunOptions& options, const Scene& scene,
                                         const std::vector<NamedFile>& sources);

/// Makes the folder ready for a run that has no more reason not to begin; one that begins at its
/// start has it for itself. **Collective.**
void prepare_outputs(const Scene& scene, bool begins_anew, const Communicator& ranks);

} // namespace carrom

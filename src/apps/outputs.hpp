// SPDX-License-Identifier: BSD-3-Clause
// Before a run begins: that what its scene wants written can be written, is nothing that is read or
// belongs to another run, and that no other run is writing there now.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/destinations.hpp"
#include "io/write_lock.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// What is wrong with the places of the scene's outputs, thrown as InputError on every rank;
/// CollectiveError, code 4, where the places are right and the disk refuses. `sources` are files
/// that are read, `others` what else is written. Makes the folder for checkpoints. Rank 0's locks
/// must live as long as the run writes. **Collective.**
std::vector<WriteLock> claim_outputs(const Scene& scene, const std::vector<NamedFile>& sources,
                                     const std::vector<NamedFile>& others,
                                     const Communicator& ranks);

/// The same for a run that will not begin, so that all is told at once: makes nothing, locks
/// nothing.
std::vector<Problem> problems_of_outputs(const Scene& scene, const std::vector<NamedFile>& sources);

/// Throws InputError on every rank where the run would write over whole checkpoints of another one;
/// `first_step` is that of the checkpoint it goes on from, or -1. Tells, on rank 0, of older ones
/// of this very run. **Collective.**
void check_older_checkpoints(const Scene& scene, std::int64_t first_step,
                             const Communicator& ranks);

} // namespace carrom

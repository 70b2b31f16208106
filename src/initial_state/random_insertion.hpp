// SPDX-License-Identifier: BSD-3-Clause
// Places discs at random without overlaps; all ranks share the work. The result is the same for any
// number of ranks.
//
// In round k every disc without a position proposes one. It is uniform in the area where the
// disc's centre may lie, and a function of (seed, attempt, id, k). It is rejected if it overlaps a
// fixed body, a placed disc, or a proposal of the same round with a lower id. Otherwise the disc is
// placed there. A proposal is tested by the rank whose strip of x contains it; this rank also gets
// all proposals within a diameter of its strip. A packing of 0.3 takes some 150 rounds and 3
// proposals a disc; 0.5 takes 10,000 rounds and 66 proposals. The cost diverges towards 0.54, where
// random insertion jams. So when free places are rare, rounds run in batches, by all threads
// (insertion_batch.hpp). Memory: about 75 bytes a disc, divided among the ranks.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns the scene's discs with positions but without velocities, each on the rank whose strip
/// contains it. `given` are the discs of groups with other generators, which already have
/// positions; they are in any distribution. Throws InputError on every rank if no arrangement is
/// found. **Collective.**
std::vector<InputDisc> insert_at_random(const SceneParameters& scene,
                                        const Communicator& communicator, int n_threads = 1,
                                        const std::vector<InputDisc>& given = {});

} // namespace carrom

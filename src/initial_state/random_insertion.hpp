// SPDX-License-Identifier: BSD-3-Clause
// Random positions without overlaps, found by all ranks together, the same for any number of them.
//
// In round k every disc without a position proposes one, which is a pure function of (seed, id, k),
// uniform in [r, L-r]^2. The proposal is rejected if it overlaps a placed disc, or a proposal of
// the same round with a lower id. Otherwise the disc is placed there. Proposals are judged by the
// rank whose strip of x holds them, which also gets all proposals within a diameter of its strip.
// At a packing of 0.3 some 150 rounds and 3 proposals a disc are needed, at 0.5 10,000 rounds and
// 66 proposals. The cost explodes towards 0.54, where random insertion jams. So rounds are judged
// in batches when free places are rare (insertion_batch.hpp), by all threads. Memory: about 75
// bytes a disc, divided among the ranks.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns the scene's discs with places and without velocities, each on the rank whose strip holds
/// it. `given` are the discs that already have positions, because their groups have another
/// generator. They may be in any distribution. Throws InputError on every rank if no arrangement is
/// found. **Collective.**
std::vector<InputDisc> insert_at_random(const SceneParameters& scene,
                                        const Communicator& communicator, int n_threads = 1,
                                        const std::vector<InputDisc>& given = {});

} // namespace carrom

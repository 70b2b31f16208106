// SPDX-License-Identifier: BSD-3-Clause
// Random positions without overlaps, found by all ranks together, the same for any number of them.
//
// In round k every disc without a place proposes one, a pure function of (seed, id, k), uniform in
// [r, L-r]^2. It is rejected if it overlaps a disc that has its place, or a proposal of the same
// round with a lower id; otherwise it is the disc's place. Proposals are judged by the rank whose
// strip of x holds them, which also hears of everything within a diameter of its strip. At a
// packing of 0.3 some 150 rounds and 3 proposals a disc are needed, at 0.5 10,000 rounds and 66
// proposals. The cost explodes towards 0.54, where random insertion jams. So rounds are judged in
// batches once places are rare (insertion_batch.hpp), and all threads judge. About 75 bytes a disc,
// shared out over the ranks.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns the scene's discs with places and without velocities, each on the rank whose
/// strip holds it. `given` are those that have places already, in any distribution: the discs of
/// all groups with another generator. InputError on every rank if no arrangement is found.
/// **Collective.**
std::vector<InputDisc> insert_at_random(const SceneParameters& scene,
                                        const Communicator& communicator, int n_threads = 1,
                                        const std::vector<InputDisc>& given = {});

} // namespace carrom

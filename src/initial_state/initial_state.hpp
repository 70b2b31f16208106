// SPDX-License-Identifier: BSD-3-Clause
// The discs that a scene begins with, in any distribution over the ranks: generated if
// it asks for that, or read from its list or file.
#pragma once

#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Every disc of the scene exactly once, each on some rank; no rank holds more than its share and a
/// bounded chunk. Compressed starts need engines (simulation/compression.hpp). `lines` is the
/// stream of listed discs on rank 0 (null where the scene generates); its problems become an
/// InputError on every rank. Scenes with a generator give the same discs for any number of ranks.
/// **Collective.**
std::vector<InputDisc> initial_state(const SceneParameters& scene, std::istream* lines,
                                     const Communicator& communicator, int n_threads = 1);

} // namespace carrom

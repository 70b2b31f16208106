// SPDX-License-Identifier: BSD-3-Clause
// Dense initial states by compression (Lubachevsky and Stillinger, J. Stat. Phys. 60, 561 (1990)).
//
// A random gas of small discs runs under the event-driven method while radii grow, in stretches.
// After each stretch the root mean square speed is scaled back to 1. How much it rose in a stretch
// shows how much room is left, which determines how far radii grow in the next one. All sums are
// exact, so the bits do not depend on the numbers of ranks and threads.
#pragma once

#include <vector>

#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns positions of discs with the scene's radii, in any distribution over the ranks;
/// velocities have no meaning. Throws InputError on every rank if the discs jam before they reach
/// their radii. **Collective.**
std::vector<InputDisc> compressed_places(const SceneParameters& scene,
                                         const Communicator& communicator, const Tuning& tuning);

} // namespace carrom

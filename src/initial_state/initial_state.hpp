// SPDX-License-Identifier: BSD-3-Clause
// The discs that a scene begins with, in any distribution over the ranks: generated if
// it asks for that, or read from its list or file.
#pragma once

#include <istream>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Places of discs on a lattice or at random, as the scene's generator says, without velocities.
/// **Collective.**
std::vector<InputDisc> generated_places(const SceneParameters& scene,
                                        const Communicator& communicator, int n_threads);

/// initial_state without the velocities that are drawn or turned round. **Collective.**
std::vector<InputDisc> initial_places(const SceneParameters& scene, std::istream* lines,
                                      const Communicator& communicator, int n_threads);

/// Gives the velocities that initial_places leaves out. **Collective.**
void give_first_velocities(const SceneParameters& scene, std::vector<InputDisc>& discs,
                           const Communicator& communicator);

/// Refuses discs that are not clear of all obstacles; the message names the first few.
/// **Collective.**
void refuse_in_obstacles(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                         const Communicator& communicator);

/// Every disc of the scene exactly once, each on some rank; no rank holds more than its share and a
/// bounded chunk. Compressed starts and groups need engines (simulation/first_discs.hpp). `lines`
/// is the stream of listed discs on rank 0 (null where the scene generates); its problems become an
/// InputError on every rank. Scenes with a generator give the same discs for any number of ranks.
/// **Collective.**
std::vector<InputDisc> initial_state(const SceneParameters& scene, std::istream* lines,
                                     const Communicator& communicator, int n_threads = 1);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Makes the initial discs of a scene with any generator. load_places (scene_input.hpp) handles only
// some of the generators.
//
// Groups are placed one after the other. Lattices and compressed discs fill their regions as if
// each region were a box; then random discs are placed in the gaps. Velocities are drawn last,
// after the discs that the scene freezes have become fixed bodies.
#pragma once

#include <istream>
#include <vector>

#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns the scene's discs, in any distribution over the ranks, with velocities. `following` is
/// as in load_places. The scene must not freeze discs. Throws InputError on every rank if discs
/// cannot be read or placed. **Collective.**
std::vector<InputDisc> first_discs(const SceneParameters& scene, std::istream* following,
                                   const Communicator& communicator, const Tuning& tuning);

/// Like first_discs, but the scene may freeze discs: they become fixed bodies (frozen_discs.hpp).
/// **Collective.**
std::vector<InputDisc> first_discs_and_frozen(SceneParameters& scene, std::istream* following,
                                              const Communicator& communicator,
                                              const Tuning& tuning);

} // namespace carrom

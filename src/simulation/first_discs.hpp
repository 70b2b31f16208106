// SPDX-License-Identifier: BSD-3-Clause
// Makes the discs of a scene's start, for any generator; other functions handle only some of the
// generators.
//
// Groups are placed one after the other. Lattices and compressed discs fill their regions, each
// like a box of its own, and random discs are then placed in the gaps. Velocities are given last,
// when discs that the scene freezes have become fixed bodies.
#pragma once

#include <istream>
#include <vector>

#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns the scene's discs, in any distribution over the ranks, with velocities. `following` is
/// as in load_places. If the scene freezes discs, it must contain them already. Throws InputError
/// on every rank. **Collective.**
std::vector<InputDisc> first_discs(const SceneParameters& scene, std::istream* following,
                                   const Communicator& communicator, const Tuning& tuning);

/// Like first_discs. Discs that the scene freezes become its fixed bodies (frozen_discs.hpp).
/// **Collective.**
std::vector<InputDisc> first_discs_and_frozen(SceneParameters& scene, std::istream* following,
                                              const Communicator& communicator,
                                              const Tuning& tuning);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The discs that a scene begins with, for any generator: the only way to them that knows all.
//
// Groups come one after the other. Lattices and compressed discs fill their regions, each as a box
// of its own, and random discs then find places in the gaps. Velocities come last, after discs that
// the scene freezes have become obstacles.
#pragma once

#include <istream>
#include <vector>

#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns the scene's discs, in any distribution over the ranks, with velocities. `following` is
/// that of load_places. Where the scene freezes discs it must know them already. Throws InputError
/// on every rank. **Collective.**
std::vector<InputDisc> first_discs(const SceneParameters& scene, std::istream* following,
                                   const Communicator& communicator, const Tuning& tuning);

/// As first_discs. Discs that the scene freezes become its obstacles (frozen_discs.hpp).
/// **Collective.**
std::vector<InputDisc> first_discs_and_frozen(SceneParameters& scene, std::istream* following,
                                              const Communicator& communicator,
                                              const Tuning& tuning);

} // namespace carrom

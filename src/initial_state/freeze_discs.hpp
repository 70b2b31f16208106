// SPDX-License-Identifier: BSD-3-Clause
// Finds the discs of a start that become obstacles, and takes them out of the discs that move.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Discs whose centres lie in a region of `discs.freeze`, edges included, or that are of a frozen
/// group, become obstacles of the scene (set_frozen). The others get the ids 0 to n - 1 in the
/// order of theirs. Throws InputError on every rank if no disc freezes, or all do. **Collective.**
void freeze_discs(SceneParameters& scene, std::vector<InputDisc>& discs, const Communicator& ranks);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Turns discs of the initial state into fixed bodies, and removes them from the moving discs.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Turns some discs into fixed bodies (set_frozen): those whose centres lie in a region of
/// `discs.freeze`, edges included, and all discs of a frozen group. The other discs are renumbered
/// from 0, in order of their old ids. Throws InputError on every rank if no disc or every disc
/// would freeze. **Collective.**
void freeze_discs(SceneParameters& scene, std::vector<InputDisc>& discs, const Communicator& ranks);

} // namespace carrom

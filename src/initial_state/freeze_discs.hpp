// SPDX-License-Identifier: BSD-3-Clause
// Turns discs of the initial state into obstacles, and removes them from the moving discs.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Discs whose centres lie in a region of `discs.freeze`, edges included, or that belong to a
/// frozen group, become obstacles of the scene (set_frozen). The remaining discs get the ids 0 to n
/// - 1 in the order of their old ids. Throws InputError on every rank if no disc freezes, or all
/// do. **Collective.**
void freeze_discs(SceneParameters& scene, std::vector<InputDisc>& discs, const Communicator& ranks);

} // namespace carrom

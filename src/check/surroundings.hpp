// SPDX-License-Identifier: BSD-3-Clause
// Finds the discs around one that breaks an invariant, enough for a scene that repeats it.
#pragma once

#include <span>
#include <vector>

#include "check/finding.hpp"
#include "core/image.hpp"
#include "engine/collision.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// In the units of scenes: per step, in the box.
struct SceneDisc {
    InputDisc disc;
    double spin = 0;
};

/// The finding's discs, those that they collided with in `log`, and the nearest, a
/// dozen in the order of ids. `discs` are this rank's share; those of rank `keeper`
/// include the finding's disc. All ranks get the same list. **Collective.**
std::vector<SceneDisc> discs_around(const Finding& finding, std::span<const SceneDisc> discs,
                                    int keeper, std::span<const Collision> log,
                                    const Periods& periods, const Communicator& communicator);

} // namespace carrom

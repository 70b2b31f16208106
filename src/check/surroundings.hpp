// SPDX-License-Identifier: BSD-3-Clause
// Collects discs around a disc that breaks an invariant, so that a scene can repeat the error.
#pragma once

#include <span>
#include <vector>

#include "check/finding.hpp"
#include "core/image.hpp"
#include "engine/collision.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// A disc in scene units: velocity per step, position in the box.
struct SceneDisc {
    InputDisc disc;
    double spin = 0;
};

/// Returns about a dozen discs in order of id: the finding's discs, the discs that collided
/// with them in `log`, and the nearest discs. `discs` are this rank's share; on rank `keeper` they
/// include the finding's disc. All ranks get the same list. **Collective.**
std::vector<SceneDisc> discs_around(const Finding& finding, std::span<const SceneDisc> discs,
                                    int keeper, std::span<const Collision> log,
                                    const Periods& periods, const Communicator& communicator);

} // namespace carrom

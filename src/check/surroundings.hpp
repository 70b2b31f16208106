// SPDX-License-Identifier: BSD-3-Clause
// Which discs stand around one that breaks an invariant: enough for a scene that repeats it.
#pragma once

#include <span>
#include <vector>

#include "check/finding.hpp"
#include "core/image.hpp"
#include "engine/collision.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// As scenes give discs: per step, in the box.
struct SceneDisc {
    InputDisc disc;
    double spin = 0;
};

/// The finding's discs, those that they collided with in `log`, and the nearest, in the order of
/// ids: a dozen. `discs` are this rank's share; those of rank `keeper` have the finding's disc. The
/// same on all ranks. **Collective.**
std::vector<SceneDisc> discs_around(const Finding& finding, std::span<const SceneDisc> discs,
                                    int keeper, std::span<const Collision> log,
                                    const Periods& periods, const Communicator& communicator);

} // namespace carrom

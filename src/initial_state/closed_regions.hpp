// SPDX-License-Identifier: BSD-3-Clause
// Finds discs that random insertion has put where obstacles shut them off from the other discs, as
// inside a polygon of segments. There they have another density than the scene seems to say.
//
// The box is covered with points two thirds of the smallest radius apart. Those where the smallest
// disc would overlap an obstacle by more than that are blocked, and those near the lines across
// gaps that are too narrow (narrow_gaps.hpp). A flood fill finds which others hang together. So a
// gap counts as a way out if the smallest disc fits through. A region at an open side has a way
// out. Four bytes and a few nanoseconds a point on each rank.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct ShutInDiscs {
    std::uint64_t n_discs = 0; ///< outside the largest region
    std::uint64_t n_regions = 0;
};

/// `discs` are in any distribution over the ranks. Nothing is found in boxes that would take more
/// than four million points. **Collective.**
ShutInDiscs find_shut_in(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                         const Communicator& communicator);

} // namespace carrom

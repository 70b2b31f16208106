// SPDX-License-Identifier: BSD-3-Clause
// Finds discs that random insertion has placed in regions that fixed bodies separate from the other
// discs, such as the inside of a polygon of segments. The density there differs from the density
// elsewhere, which the author of a scene may not expect.
//
// The box is covered with points that are two thirds of the smallest radius apart. A point is
// blocked if the smallest disc there would overlap a fixed body by more than this distance, if the
// point is near a line across a gap that is too narrow (narrow_gaps.hpp), or if it is outside of a
// box that is not a rectangle. A flood fill finds the connected regions of free points. So regions
// are connected if the smallest disc fits through the gap between them. A region at an open side is
// not closed. Cost: four bytes and a few nanoseconds a point on each rank.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct ShutInDiscs {
    std::uint64_t n_discs = 0; ///< discs in closed regions; the largest region never counts
    std::uint64_t n_regions = 0;
};

/// Counts the discs in closed regions; `discs` are in any distribution over the ranks. Returns
/// zeros if the box would need more than four million points. **Collective.**
ShutInDiscs find_shut_in(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                         const Communicator& communicator);

} // namespace carrom

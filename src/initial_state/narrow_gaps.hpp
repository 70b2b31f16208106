// SPDX-License-Identifier: BSD-3-Clause
// Finds the gaps between obstacles that are too narrow for a disc, and draws a line across each.
//
// Where two obstacles are nearer than the disc's diameter, every point of the line between their
// nearest points is nearer than a radius to one of them, so no centre of a disc crosses it. The
// lines and the obstacles together so divide the box as the places of a disc are divided. A sweep
// along x finds the pairs: their number is about that of obstacles times those in a strip.
#pragma once

#include <vector>

#include "dynamics/effects.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Lines across the gaps between obstacles, and between them and walls at rest, through which no
/// disc of this radius fits. Where sides are periodic, images of obstacles count as well.
std::vector<Segment> lines_across_narrow_gaps(const SceneParameters& scene, double radius);

} // namespace carrom

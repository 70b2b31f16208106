// SPDX-License-Identifier: BSD-3-Clause
// Finds the gaps between obstacles that are too narrow for a disc, and draws a line across each.
//
// If two obstacles are closer than the disc's diameter, every point of the line between their
// nearest points is within a radius of one of them, so the centre of a disc cannot cross it. So the
// lines and the obstacles together divide the box into the regions that a disc cannot leave. A
// sweep along x finds the pairs of near obstacles. Its cost is the number of obstacles times the
// number of those in a strip.
#pragma once

#include <vector>

#include "dynamics/effects.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Lines across the gaps between obstacles, and between them and walls at rest, through which no
/// disc of this radius fits. Images of obstacles beyond periodic sides are included.
std::vector<Segment> lines_across_narrow_gaps(const SceneParameters& scene, double radius);

} // namespace carrom

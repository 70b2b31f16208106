// SPDX-License-Identifier: BSD-3-Clause
// Finds the gaps between fixed bodies that are too narrow for a disc, and draws a line across each.
//
// If two fixed bodies are closer than the disc's diameter, every point of the line between their
// nearest points is within a radius of one of them, so no disc's centre crosses it. So the lines
// and the fixed bodies together divide the box into the regions that a disc cannot leave. A sweep
// along x finds the pairs: their number is about that of fixed bodies times those in a strip.
#pragma once

#include <vector>

#include "dynamics/effects.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Lines across the gaps between fixed bodies, and between them and walls at rest, through which no
/// disc of this radius fits. Images of fixed bodies beyond periodic sides are included.
std::vector<Segment> lines_across_narrow_gaps(const SceneParameters& scene, double radius);

} // namespace carrom

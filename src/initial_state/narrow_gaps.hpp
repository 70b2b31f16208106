// SPDX-License-Identifier: BSD-3-Clause
// Finds the gaps between fixed bodies that are too narrow for a disc, and draws a line across each.
//
// If two fixed bodies are closer than the disc's diameter, every point of the line between their
// nearest points is within a radius of one body, so no disc's centre crosses the line. So these
// lines and the fixed bodies divide the box into regions that a disc cannot leave. A sweep along x
// finds the pairs. It compares a body only with bodies less than a diameter away along x.
#pragma once

#include <vector>

#include "dynamics/effects.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Lines across the gaps through which no disc of this radius fits: between two fixed bodies, and
/// between a fixed body and a wall at rest. Images beyond periodic sides are included.
std::vector<Segment> lines_across_narrow_gaps(const SceneParameters& scene, double radius);

} // namespace carrom

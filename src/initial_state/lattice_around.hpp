// SPDX-License-Identifier: BSD-3-Clause
// A triangular lattice around obstacles, and in boxes that are not rectangles.
//
// Rows lie along x. The number of rows m determines the spacing a. Along x the lattice is stretched
// so that a whole number of sites fits the box. A site is free if it is at least a / 2 from all
// walls and obstacles. So a disc there can be moved by a / 2 less its radius in any direction,
// without overlaps and without leaving the box. The smallest m with enough free sites is used.
// Sites in excess stay empty, spread evenly.
//
// Sites are counted for some 20 values of m, each rank counting its share of the rows. Memory is
// that of the discs.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns the scene's discs, each moved by a random distance from its site, in any distribution
/// over the ranks. Throws InputError on every rank if there are not enough sites. **Collective.**
std::vector<InputDisc> lattice_around_obstacles(const SceneParameters& scene,
                                                const Communicator& communicator);

} // namespace carrom

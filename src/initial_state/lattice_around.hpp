// SPDX-License-Identifier: BSD-3-Clause
// A triangular lattice around fixed bodies, and in boxes that are not rectangles.
//
// Rows lie along x. The number m of rows gives the spacing a; along x, the lattice is stretched so
// that whole numbers of sites fill the box. A site is used if it is at least a / 2 from walls and
// fixed bodies, so each disc can be shifted by a / 2 less its radius without touching them. The
// smallest even m with enough sites is used. Excess sites stay empty; they are spread evenly.
//
// Sites are counted for some 20 values of m; each rank counts in its share of the rows. Memory:
// mainly the discs themselves.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// The scene's discs, each shifted at random from its site, in any distribution over the ranks.
/// Throws InputError on every rank if there are not enough sites. **Collective.**
std::vector<InputDisc> lattice_around_fixed_bodies(const SceneParameters& scene,
                                                   const Communicator& communicator);

} // namespace carrom

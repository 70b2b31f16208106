// SPDX-License-Identifier: BSD-3-Clause
// A triangular lattice around fixed bodies, and in boxes that are no rectangles.
//
// Rows lie along x. Of m rows the spacing a follows, and along x it is stretched so that whole
// numbers of sites fill the box. A site counts if it is at least a / 2 from walls and fixed bodies,
// so that each disc may be moved by a / 2 less its radius in any direction: no overlap, none
// outside. The least m with enough sites is taken. Sites in excess stay empty, spread evenly.
//
// Sites are counted for some 20 values of m, each rank counting its share of the rows. Memory is
// that of the discs.
#pragma once

#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// The scene's discs, shaken, in any distribution over the ranks. InputError on each rank if there
/// are not enough sites. **Collective.**
std::vector<InputDisc> lattice_around_fixed_bodies(const SceneParameters& scene,
                                                   const Communicator& communicator);

} // namespace carrom

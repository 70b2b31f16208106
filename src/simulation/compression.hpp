// SPDX-License-Identifier: BSD-3-Clause
// Dense starts by compression (Lubachevsky and Stillinger, J. Stat. Phys. 60, 561
// (1990)), and the only function that returns the discs that a scene starts with.
//
// A random gas of small discs runs under the event-driven method while radii grow, in
// stretches. After each stretch speeds are scaled back. The heating in a stretch shows
// how much room is left, and this decides how far discs grow in the next one. All sums
// are exact, so the discs have the same bits on any ranks and threads.
#pragma once

#include <istream>
#include <vector>

#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Returns the places of a scene whose generator is "compressed", in any distribution
/// over the ranks, with velocities that other generators would give. Throws InputError
/// on every rank if the discs jam before they have their radii. **Collective.**
std::vector<InputDisc> compressed_discs(const SceneParameters& scene,
                                        const Communicator& communicator, const Tuning& tuning);

/// Returns load_discs, or compressed discs, for any generator. **Collective.**
std::vector<InputDisc> first_discs(const SceneParameters& scene, std::istream* following,
                                   const Communicator& communicator, const Tuning& tuning);

} // namespace carrom

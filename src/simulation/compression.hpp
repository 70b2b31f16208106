// SPDX-License-Identifier: BSD-3-Clause
// Dense starts by compression (Lubachevsky and Stillinger, J. Stat. Phys. 60, 561 (1990)), and the
// one way to the discs that a scene starts with.
//
// A random gas of small discs runs under the event-driven method while radii grow, in stretches.
// After each stretch speeds are scaled back. From a stretch's heating follows how much room is
// left, and from that how far discs grow in the next one. All of it follows from exact sums, so the
// discs have the same bits on any ranks and threads.
#pragma once

#include <istream>
#include <vector>

#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// The places of a scene whose generator is "compressed", in any distribution over the ranks, and
/// velocities as for other generators. Throws InputError on every rank if the discs jam before they
/// have their radii. **Collective.**
std::vector<InputDisc> compressed_discs(const Scene& scene, const Communicator& communicator,
                                        const Tuning& tuning);

/// As load_discs, for every generator. **Collective.**
std::vector<InputDisc> first_discs(const Scene& scene, std::istream* following,
                                   const Communicator& communicator, const Tuning& tuning);

} // namespace carrom

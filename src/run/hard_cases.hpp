// SPDX-License-Identifier: BSD-3-Clause
// Warnings for scenes that are legal but lose digits, and the end of those that would lose discs
// (docs/understanding/hard-cases.md).
#pragma once

#include "parallel/communicator.hpp"
#include "run/messages.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

/// Warns if discs go noticeably far in the rounding of a time. Throws InputError on every
/// rank if they go through a box with periodic sides more often than can be counted.
/// **Collective.**
void refuse_hard_cases(const Scene& scene, const Simulation& simulation, const Communicator& ranks,
                       const Messages& messages);

/// The same for what rounding or the order of ids decides as the scene starts: discs that overlap
/// (in the time-stepped method), that touch several others, that slide along each other.
void warn_of_close_pairs(const Scene& scene, const Totals& start, const Messages& messages);

} // namespace carrom

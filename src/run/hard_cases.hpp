// SPDX-License-Identifier: BSD-3-Clause
// Warnings for scenes that are legal but lose precision, and errors for scenes whose results would
// be wrong (docs/understanding/hard-cases.md).
#pragma once

#include <string>

#include "parallel/communicator.hpp"
#include "run/messages.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// Warns if rounding of times moves a disc noticeably. Throws InputError on every rank if it moves
/// a disc by more than a radius, or if a disc crosses a periodic box too often between syncs.
/// **Collective.**
void refuse_hard_cases(const SceneParameters& scene, const DiscSystem& system,
                       const Communicator& ranks, const Messages& messages);

/// Warns if discs overlap at the start (time-stepped method), or if their collisions depend on ids
/// or on rounding, because discs touch several others or slide along each other.
void warn_of_close_pairs(const SceneParameters& scene, const Totals& start,
                         const Messages& messages);

/// Returns a warning if ranks own so few discs that halos contain more discs than domains, and
/// otherwise an empty text. The time-stepped method has thinner halos, so for it the text is always
/// empty.
std::string warning_of_small_domains(const SceneParameters& scene, int n_ranks, int n_threads);

} // namespace carrom

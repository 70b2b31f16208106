// SPDX-License-Identifier: BSD-3-Clause
// The work that led to a run's state, for reports. The sums over the state itself are public.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <carrom/totals.hpp>

namespace carrom {

/// Counts of windows and blocks of the event-driven method. They depend on the machine
/// shape, and are zero in the time-stepped method.
struct RollbackCounts {
    std::uint64_t windows = 0, windows_redone = 0; ///< redone: some block on some rank was repeated
    std::uint64_t blocks = 0,
                  blocks_redone = 0; ///< block runs on all ranks, first ones and repetitions
    /// Collisions of pairs at the time of an earlier one of one of the two discs, to within
    /// rounding, on all ranks, since the engine began: the order of ids or a rounding decides about
    /// what follows. The same for any machine shape.
    std::uint64_t simultaneous = 0;
};

/// Seconds this rank has spent, by phase, in the order they are reported.
using PhaseSeconds = std::vector<std::pair<std::string, double>>;

} // namespace carrom

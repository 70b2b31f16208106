// SPDX-License-Identifier: BSD-3-Clause
// The work that a run has done, for reports. Sums over the state itself are in carrom/totals.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <carrom/totals.hpp>

namespace carrom {

/// Counts of windows and blocks of the event-driven method. They depend on the numbers
/// of ranks and threads, and are zero in the time-stepped method.
struct RollbackCounts {
    /// windows_redone: windows in which some block on some rank was repeated
    std::uint64_t windows = 0, windows_redone = 0;
    std::uint64_t blocks = 0,
                  blocks_redone = 0; ///< first runs and repetitions of blocks, on all ranks
    /// Collisions of pairs whose time equals, within rounding, the time of the previous collision
    /// of one of the two discs. The order of ids or a rounding then decides the result. Counted on
    /// all ranks since the engine began; equal for any numbers of ranks and threads.
    std::uint64_t simultaneous = 0;
};

/// The seconds that this rank has spent in each phase, in the order in which they are reported.
using PhaseSeconds = std::vector<std::pair<std::string, double>>;

} // namespace carrom

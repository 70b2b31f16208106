// SPDX-License-Identifier: BSD-3-Clause
// What a run reports of the work that led to its state; the state's own sums are public.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <carrom/totals.hpp>

namespace carrom {

/// How the run got on in the event-driven method; depends on the machine shape. Zero in the
/// time-stepped method.
struct RollbackCounts {
    std::uint64_t windows = 0, windows_redone = 0; ///< redone: in some block at least, on any rank
    std::uint64_t blocks = 0,
                  blocks_redone = 0; ///< block runs on all ranks, first and repeated
};

/// Seconds this rank has spent, by phase, in the order they are reported.
using PhaseSeconds = std::vector<std::pair<std::string, double>>;

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Choices that affect how long a run takes, and never its result.
#pragma once

#include <cstdint>
#include <optional>

namespace carrom {

/// Unset choices are made from the scene as it runs.
struct Tuning {
    int threads = 1;
    std::uint64_t discs_per_thread = 2000; ///< a rank with fewer uses fewer threads
    std::optional<double>
        window; ///< micro-steps per window; below 1 the micro-step is cut into parts
    std::optional<double> cell_width; ///< in units of the window's reach
    std::optional<double>
        usual_speed; ///< in units of the largest speed; cells allow for it if a micro-step is cut
    std::optional<int> ranks_across;  ///< ranks that share a strip and cut it across
    std::int64_t rebalance_every = 1; ///< in syncs; 0 never moves the first cuts
    double rebalance_above =
        1.05; ///< the largest over mean load that is tolerated; 0 moves the cuts every time
    bool ends_jams = true; ///< false for steps that are known to have no jam of growing discs
};

} // namespace carrom

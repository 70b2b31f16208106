// SPDX-License-Identifier: BSD-3-Clause
// Choices that affect how long a run takes, and never its result.
#pragma once

#include <cstdint>
#include <optional>

namespace carrom {

/// Settings that are not given are chosen during the run.
struct Tuning {
    int threads = 1;
    /// Least number of discs per thread; with fewer, a thread costs more time than it saves
    std::uint64_t discs_per_thread = 2000;
    std::optional<double>
        window; ///< micro-steps per window; below 1 a micro-step is divided into parts
    std::optional<double> cell_width;  ///< width of cells relative to the window's reach
    std::optional<double> usual_speed; ///< speed that cells allow for if a micro-step is
                                       ///< divided, relative to the largest speed
    std::optional<int> ranks_across;   ///< number of ranks that share a strip and cut it across
    /// Number of syncs between two changes of the domains' cuts; with 0 the first cuts are kept
    std::int64_t rebalance_every = 1;
    /// The cuts change if the largest load exceeds the mean load by this factor; 0: every time
    double rebalance_above = 1.05;
    bool ends_jams = true; ///< whether a jam ends the run; false when safe steps are repeated
};

} // namespace carrom

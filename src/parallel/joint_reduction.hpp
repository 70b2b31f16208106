// SPDX-License-Identifier: BSD-3-Clause
// Sums and a largest value of all ranks in one message, because each reduction of a few bytes makes
// all ranks wait for the slowest.
#pragma once

#include <array>
#include <cstdint>

#include "parallel/communicator.hpp"

namespace carrom {

struct JointReduction {
    std::array<std::uint64_t, 6> sums{}; ///< wrap
    double largest = 0;                  ///< not NaN; -0 may become +0
};

/// Replaces the sums and the largest value by those over all ranks. **Collective.**
void reduce(JointReduction& values, const Communicator& communicator);

} // namespace carrom

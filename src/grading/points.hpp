// SPDX-License-Identifier: BSD-3-Clause
// The score of `carrom compare --points` in parts. A step is right if the rule leads to it from the
// student's own previous step. So a wrong rule costs only the steps in which it matters. A part
// that the output lacks is left out of the sum, unless the task requires it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace carrom {

struct Points {
    /// Whether no step is missing, each has one line for each disc, and none follows the last step
    bool are_lines_whole = true;
    bool are_in_order = true; ///< whether the lines of each step are in order of id
    /// Unset if the output lacks this part, or if it was not graded
    std::optional<bool> is_start_right, are_counters_right;
    std::int64_t n_right = 0, n_graded = 0; ///< numbers of steps after the start
    std::int64_t n_missing = 0;             ///< number of required steps that the output lacks

    /// The sum of all parts, and a line for each part.
    std::string text() const;
};

} // namespace carrom

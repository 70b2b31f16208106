// SPDX-License-Identifier: BSD-3-Clause
// The score in parts of `carrom compare --points`. A step is right if the rule leads to it from the
// student's own step before, so one wrong rule costs only the steps in which it matters. A part
// that the output does not show is left out of the sum, if the task does not ask for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace carrom {

struct Points {
    bool are_lines_whole = true; ///< each written step has all discs, and the last step is the last
    bool are_in_order = true;    ///< by id in each step
    std::optional<bool> is_start_right, are_counters_right; ///< unset: not shown, or not graded
    std::int64_t n_right = 0, n_graded = 0;                 ///< steps behind the start
    std::int64_t n_missing = 0;                             ///< steps that the task asks for

    /// The sum of all parts, and a line for each part.
    std::string text() const;
};

} // namespace carrom

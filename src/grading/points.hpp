// SPDX-License-Identifier: BSD-3-Clause
// The score in parts of `carrom compare --points`. A step is right if the rule leads to it from the
// student's own step before, so one wrong rule costs only the steps in which it matters.
#pragma once

#include <cstdint>
#include <string>

namespace carrom {

struct Points {
    bool are_lines_whole = true; ///< each written step has all discs, and nothing follows
    bool is_start_right = false;
    bool are_counters_right = false;
    std::int64_t n_right = 0, n_graded = 0; ///< steps behind the start

    /// The sum of all parts, of 100, and a line for each part.
    std::string text() const;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Why something cannot be written, and whether that is the place's fault or the disk's.
#pragma once

#include <string>

namespace carrom {

/// The reason why a file cannot be written; `text` is empty if it can.
struct WriteProblem {
    std::string text;
    bool is_failure =
        false; ///< because of the disk or a lack of rights; else the place cannot be right
};

/// The problem with the system's words for `error`, an errno, after `what`.
WriteProblem write_problem(const std::string& what, int error);

} // namespace carrom

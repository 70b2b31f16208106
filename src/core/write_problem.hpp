// SPDX-License-Identifier: BSD-3-Clause
// Why something cannot be written, and whether the path or the disk is at fault.
#pragma once

#include <string>

namespace carrom {

/// The reason why a file cannot be written; `text` is empty if it can.
struct WriteProblem {
    std::string text;
    bool is_failure = false; ///< the disk failed or rights are missing; otherwise the path is wrong
};

/// A problem that consists of `what` and the system's words for `error`, an errno.
WriteProblem write_problem(const std::string& what, int error);

} // namespace carrom

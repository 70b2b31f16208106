// SPDX-License-Identifier: BSD-3-Clause
// Why a file cannot be written, and whether the path or the disk is the cause.
#pragma once

#include <string>

namespace carrom {

/// The reason why a file cannot be written; `text` is empty if it can.
struct WriteProblem {
    std::string text;
    bool is_failure = false; ///< the cause is the disk or a missing permission, not the path
};

/// A problem with the text `what`, followed by the system's message for `error` (errno).
WriteProblem write_problem(const std::string& what, int error);

} // namespace carrom

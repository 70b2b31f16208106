// SPDX-License-Identifier: BSD-3-Clause
// What the environment says about the launcher of this process.
#pragma once

#include <string>

namespace carrom {

/// Whether a launcher has started this process, perhaps as the first of several.
/// Processes of a launcher that is not listed here each run alone.
bool has_launcher();

/// Whether this process is alone, or the first of those that its launcher has started.
bool is_first_process();

/// A process that the launcher of another MPI library has started with others. They do
/// not know each other, and each would write the same files.
struct LoneProcess {
    std::string problem;  ///< empty if there is no problem
    bool is_first = true; ///< among the processes that the launcher has started
};

/// `n_ranks` is the number of ranks that MPI knows of.
LoneProcess lone_process(int n_ranks);

} // namespace carrom

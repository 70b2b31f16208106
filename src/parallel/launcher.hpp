// SPDX-License-Identifier: BSD-3-Clause
// What the environment tells about the launcher that has started this process.
#pragma once

#include <string>

namespace carrom {

/// Whether a launcher has started this process, as the first of several perhaps. One that is
/// missing here leaves each process to itself.
bool has_launcher();

/// What a launcher of another MPI library has started: processes that do not know each other, each
/// of which would write the same files.
struct LoneProcess {
    std::string problem;  ///< empty where all is well
    bool is_first = true; ///< among those that the launcher has started
};

/// `n_ranks`: those that MPI knows of.
LoneProcess lone_process(int n_ranks);

} // namespace carrom

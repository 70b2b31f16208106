// SPDX-License-Identifier: BSD-3-Clause
// Facts about the launcher of this process, from the environment.
#pragma once

#include <string>

namespace carrom {

/// Whether a launcher has started this process. If this function does not recognise a launcher,
/// each of its processes runs alone.
bool has_launcher();

/// Whether this process is alone, or the first one that its launcher has started.
bool is_first_process();

/// A process that the launcher of another MPI library has started together with others. Such
/// processes are not connected, and all of them would write the same files.
struct LoneProcess {
    std::string problem;  ///< empty if there is no problem
    bool is_first = true; ///< whether it is the first process that the launcher has started
};

/// `n_ranks` is the number of ranks according to MPI.
LoneProcess lone_process(int n_ranks);

} // namespace carrom

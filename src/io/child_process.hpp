// SPDX-License-Identifier: BSD-3-Clause
// HDF5 crashes on some forged metadata, and loops for ever on other metadata. So a child process, a
// fork with limits on time and memory, reads the metadata first. It uses HDF5's plain driver
// without MPI and OpenMP, and exits without cleaning up. Cost: some milliseconds.
#pragma once

#include <functional>

namespace carrom {

/// Calls `inspect` in a child process, and then in this process. Throws the child's FileError; also
/// throws one if the child crashes, or takes more than ten seconds of processor time or 4 GiB of
/// additional memory. Throws MachineError if it cannot start, gets SIGKILL, or waits for 50 s.
void inspect_in_child_first(const std::function<void()>& inspect);

} // namespace carrom

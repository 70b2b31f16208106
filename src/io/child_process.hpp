// SPDX-License-Identifier: BSD-3-Clause
// HDF5 crashes on some forged metadata, and loops for ever on others. So a child process,
// a fork with limits to its time and memory, reads them first. It calls HDF5's plain
// driver, neither MPI nor OpenMP, and ends without cleaning up. Price: some milliseconds.
#pragma once

#include <functional>

namespace carrom {

/// Calls `inspect` in a child process, and then here. Throws FileError with what it throws,
/// or if it does not end there within ten seconds of processor time and 4 GiB more memory.
/// MachineError if the child cannot be started, is killed, or waits for 50 s.
void inspect_in_child_first(const std::function<void()>& inspect);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// HDF5 crashes on some forged metadata, and loops for ever on other. So a child process, a fork
// with limits to its time and memory, reads the metadata first. It uses HDF5's plain driver without
// MPI and OpenMP, and ends without cleaning up. Price: some milliseconds.
#pragma once

#include <functional>

namespace carrom {

/// Calls `inspect` in a child process, and then here. Throws FileError with the text of an
/// exception in the child, or if the child needs more than ten seconds of processor time or 4 GiB
/// more memory. Throws MachineError if the child cannot be started, is killed, or waits for 50 s.
void inspect_in_child_first(const std::function<void()>& inspect);

} // namespace carrom

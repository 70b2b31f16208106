// SPDX-License-Identifier: BSD-3-Clause
// HDF5 does not survive all metadata: a wrong size of a heap, say, makes it read from nowhere, and
// a wrong place makes it look for ever. So what may be forged is read in a child process first,
// with limits to its time and memory. What the child has survived the program may read itself.
//
// The child is a fork: it shares the file and all that is known of it, and ends without cleaning
// up. It calls HDF5's plain driver and neither MPI nor OpenMP. Price: some milliseconds.
#pragma once

#include <functional>

namespace carrom {

/// Calls `look` in a child process. Throws FileError with what it throws there, or where it does
/// not come to an end within ten seconds of processor time and 4 GiB more memory.
void try_in_child(const std::function<void()>& look);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// What the library for files needs to know before anything else happens.
#pragma once

#include <string>

namespace carrom {

/// To be called once, before MPI starts. HDF5 then leaves nothing to be done at the program's end:
/// after a failed write it would try again there, and HDF5 1.10 crashes at that, which hides the
/// exit code. Every file is closed where it is used. And a file system without locks is no reason
/// to refuse a file (unless HDF5_USE_FILE_LOCKING says so). A write beyond the limit to the size of
/// files (ulimit -f) fails from then on like any other, instead of ending the process.
void start_io();

/// HDF5's version, "1.10.8". Needs no start.
std::string hdf5_version();

} // namespace carrom

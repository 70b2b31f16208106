// SPDX-License-Identifier: BSD-3-Clause
// Settings of HDF5 and the system that must be made before anything else.
#pragma once

#include <string>

namespace carrom {

/// To be called once, before MPI starts. HDF5 then does nothing at the program's end.
/// Otherwise it would repeat a failed write there, at which HDF5 1.10 crashes, which hides
/// the exit code. Every file is closed where it is used. A file system without locks does
/// not make HDF5 refuse a file (unless HDF5_USE_FILE_LOCKING says so). A write beyond the
/// limit to file sizes (ulimit -f) fails like any other, instead of ending the process.
void start_io();

/// HDF5's version, "1.10.8". Needs no start.
std::string hdf5_version();

} // namespace carrom

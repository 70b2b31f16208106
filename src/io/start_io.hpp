// SPDX-License-Identifier: BSD-3-Clause
// Settings of HDF5 and the system that must be made before anything else.
#pragma once

#include <string>

namespace carrom {

/// Call it once, before MPI starts. HDF5 then does nothing at the program's end. Otherwise it would
/// repeat a failed write, at which HDF5 1.10 crashes, so that the exit code is lost. HDF5 does not
/// lock files, whatever HDF5_USE_FILE_LOCKING is, follows no links into other files and loads no
/// plugins. A write beyond the limit of file sizes (ulimit -f) then returns an error instead of
/// ending the process.
void start_io();

/// The version of HDF5, such as "1.10.8". Can be called before `start_io`.
std::string hdf5_version();

} // namespace carrom

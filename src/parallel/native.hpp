// SPDX-License-Identifier: BSD-3-Clause
// MPI's own handle, for libraries that need one (parallel HDF5). Only code that calls such a
// library includes this header.
#pragma once

#include <mpi.h>

#include "parallel/communicator.hpp"

namespace carrom {

/// MPI's handle of `communicator`, valid as long as `communicator` exists. MPI_COMM_NULL if MPI has
/// not been started. **Not collective.**
MPI_Comm native(const Communicator& communicator);

} // namespace carrom

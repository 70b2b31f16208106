// SPDX-License-Identifier: BSD-3-Clause
// MPI's own handle, for libraries that need one (parallel HDF5). Nothing else includes this header.
#pragma once

#include <mpi.h>

#include "parallel/communicator.hpp"

namespace carrom {

/// What `communicator` stands for; good as long as it is. **Not collective.**
MPI_Comm native(const Communicator& communicator);

} // namespace carrom

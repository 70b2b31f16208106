// SPDX-License-Identifier: BSD-3-Clause
#include "apps/version_text.hpp"

#include <fmt/format.h>

#include "io/start_io.hpp"
#include "machine/machine.hpp"
#include "parallel/mpi.hpp"

namespace carrom {

std::string version_text() {
    const BuildFacts facts = build_facts();
    return fmt::format("carrom {}\n"
                       "commit    {}\n"
                       "compiler  {}\n"
                       "MPI       {}\n"
                       "HDF5      {}\n"
                       "vectors   {}",
                       version(), facts.commit, facts.compiler, mpi_version(), hdf5_version(),
                       vector_target());
}

} // namespace carrom

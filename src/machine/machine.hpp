// SPDX-License-Identifier: BSD-3-Clause
// Facts about the machine of a run: cores to use, memory used, and how the program was
// built.
#pragma once

#include <cstdint>
#include <string>

#include <carrom/version.hpp>

#include "parallel/communicator.hpp"

namespace carrom {

/// How the program was built, for reports of measurements.
struct BuildFacts {
    std::string compiler; ///< such as "GNU 12.2.0"
    std::string flags;    ///< optimisation flags of this build, and flags of all targets
    /// The commit when the build was configured, such as "0123456789ab"; or "unknown"
    std::string commit;
};
BuildFacts build_facts();

/// The best vector instructions that this processor supports and that the program contains, such as
/// "AVX2".
std::string vector_target();

/// The processor's name; empty if the system does not report it.
std::string processor_name();

/// The number of threads of this rank if the user has not chosen one: OMP_NUM_THREADS, or the cores
/// that the rank may use, divided by the number of ranks of its node that may use the same cores;
/// at least 1. **Collective.**
int default_threads(const Communicator& ranks);

/// Throws CollectiveError if a rank cannot start this many threads, because OpenMP would then end
/// the program with its own exit code. **Collective.**
void check_threads(int threads, const Communicator& ranks);

/// Names the limit of this process by which MPI and threads have too little memory or too few open
/// files to start; empty if there is none. Otherwise libraries would end the program with exit
/// codes of their own.
std::string limit_in_the_way();

/// A warning with a better number of threads if a rank has more threads than cores, if ranks that
/// share cores have more than two threads a core together, or if a rank has more threads than its
/// discs can use; else empty. **Collective.**
std::string warning_of_crowded_threads(int threads, std::uint64_t n_discs,
                                       const Communicator& ranks);

/// A warning if OMP_NUM_THREADS is set, but not to a number of threads; else
/// empty.
std::string warning_of_thread_variable();

/// The memory in bytes that this rank may use: the least of its share of the node's memory, its
/// share of its control group's limit, and the limit of its process; the largest number if the
/// system does not report them. **Collective.**
std::uint64_t memory_per_rank(const Communicator& ranks);

/// The largest memory in bytes that this process has used at any time; 0 if the system does not
/// report it.
std::uint64_t peak_resident_bytes();

} // namespace carrom

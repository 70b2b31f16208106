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

/// The default number of threads of this rank: OMP_NUM_THREADS if it is set. Otherwise the number
/// of cores that the rank may use, divided by the number of ranks on its node that may use the same
/// cores, but at least 1. **Collective.**
int default_threads(const Communicator& ranks);

/// Throws CollectiveError if a rank cannot start this many threads, because OpenMP would then end
/// the program with its own exit code. **Collective.**
void check_threads(int threads, const Communicator& ranks);

/// An error message if a limit of this process, on memory or on open files, is too low for MPI and
/// threads to start; else empty. Without this check libraries would end the program with their own
/// exit codes.
std::string limit_in_the_way();

/// A warning with a better number of threads if a rank has more threads than cores, if ranks that
/// share cores together have more than two threads per core, or if a rank has more threads than its
/// discs can use; else empty. **Collective.**
std::string warning_of_crowded_threads(int threads, std::uint64_t n_discs,
                                       const Communicator& ranks);

/// A warning if OMP_NUM_THREADS is set, but not to a number of threads; else
/// empty.
std::string warning_of_thread_variable();

/// The memory in bytes that this rank may use: the smallest of its share of the node's memory, its
/// share of its control group's limit, and the limit of its process; a huge number if the system
/// reports none of these. **Collective.**
std::uint64_t memory_per_rank(const Communicator& ranks);

/// The largest memory in bytes that this process has used at any time; 0 if the system does not
/// report it.
std::uint64_t peak_resident_bytes();

} // namespace carrom

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
    std::string compiler; ///< "GNU 12.2.0"
    std::string flags;    ///< optimisation flags, and those of all targets
    std::string commit;   ///< "0123456789ab", when the build was configured; or "unknown"
};
BuildFacts build_facts();

/// The best vector instructions that this processor runs and that were compiled, such as "AVX2".
std::string vector_target();

/// The processor's name; empty if the system does not report it.
std::string processor_name();

/// The threads of this rank if the user has not chosen: OMP_NUM_THREADS, else the cores it may
/// use, divided by the ranks of its node that may use the same ones; at least 1. **Collective.**
int default_threads(const Communicator& ranks);

/// Throws CollectiveError if a rank cannot have so many threads at once, because
/// OpenMP itself would end the program then, with its own code. **Collective.**
void check_threads(int threads, const Communicator& ranks);

/// The limit of this process that leaves MPI and threads too little memory or too few open files to
/// start; empty if there is none. Libraries would end the program, each with a code of its own.
std::string limit_in_the_way();

/// A warning with the number of threads to take if a rank has more threads than cores, if ranks
/// that share cores have more than twice as many together, or if a rank has more than its discs
/// keep at work; else empty. **Collective.**
std::string warning_of_crowded_threads(int threads, std::uint64_t n_discs,
                                       const Communicator& ranks);

/// A warning if OMP_NUM_THREADS is set, but not to a number of threads; else
/// empty.
std::string warning_of_thread_variable();

/// The bytes of memory that this rank may take: those of its node, or as many as its
/// control group or limits allow, divided by the ranks of the node; the largest number
/// if the system does not report it. **Collective.**
std::uint64_t memory_per_rank(const Communicator& ranks);

/// The most bytes of memory this process has held at any time; 0 if the system does
/// not report it.
std::uint64_t peak_resident_bytes();

} // namespace carrom

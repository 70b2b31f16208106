// SPDX-License-Identifier: BSD-3-Clause
// What a run has to know of the machine it is on: cores to use, memory used, and what the program
// was built with.
#pragma once

#include <cstdint>
#include <string>

#include <carrom/version.hpp>

#include "parallel/communicator.hpp"

namespace carrom {

/// What the program was built with, as measurements should say.
struct BuildFacts {
    std::string compiler; ///< "GNU 12.2.0"
    std::string flags;    ///< of optimisation, and what holds for all targets
    std::string commit;   ///< "0123456789ab", when the build was configured; or "unknown"
};
BuildFacts build_facts();

/// The vector instructions that this processor runs, "AVX2": the best that was compiled.
std::string vector_target();

/// The processor's name; empty where the system does not report it.
std::string processor_name();

/// Threads for this rank when nobody chose: OMP_NUM_THREADS, else the cores it may use, shared out
/// among the ranks of its node that may use the same ones; at least 1. **Collective.**
int default_threads(const Communicator& ranks);

/// Throws CollectiveError where a rank cannot have so many threads at once: OpenMP itself would end
/// the program there, with its own code. **Collective.**
void check_threads(int threads, const Communicator& ranks);

/// What to say where OMP_NUM_THREADS is set to something that is no number of threads; empty where
/// all is well.
std::string warning_of_thread_variable();

/// What to say where threads of several ranks share cores, and wait for each other as GNU's OpenMP
/// library does by default: they spin for milliseconds, on the very core that the awaited thread
/// needs. (Within one process the library sees that itself, and sleeps.) Empty where all is well.
/// **Collective.**
std::string warning_of_shared_cores(int threads, const Communicator& ranks);

/// The memory this rank may take, in bytes: what its node has, or its control group or limits
/// allow, shared out among the ranks of the node; the largest number where the system does not
/// tell. **Collective.**
std::uint64_t memory_per_rank(const Communicator& ranks);

/// The most memory this process has held at any time, in bytes; 0 where the system does not report
/// it.
std::uint64_t peak_resident_bytes();

} // namespace carrom

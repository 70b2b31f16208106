// SPDX-License-Identifier: BSD-3-Clause
// Runs a function on all ranks of a simulated cluster. SimGrid (SMPI) replaces the MPI library and
// the network, and all ranks take turns in this one process. Computing takes no simulated time
// except in `compute_for`, so a run gives the same numbers on any machine.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace carrom {

struct SimulatedCluster {
    std::string platform; ///< an XML file with hosts node-0, node-1, ... of 1e9 operations a second
    int n_ranks = 1;
    int ranks_per_node = 1;     ///< ranks that share the network card of a node
    double bytes_stand_for = 1; ///< factor of the size of messages
};

/// Calls `life(rank)` on each rank, between MPI_Init and MPI_Finalize. Removes SimGrid's own
/// options from the command line.
void run_simulated(int& argc, char** argv, const SimulatedCluster& cluster,
                   const std::function<void(int)>& life);

/// Advances the simulated time of the calling rank.
void compute_for(double nanoseconds);

/// Messages that have entered the network so far, those inside collective operations included.
std::uint64_t n_network_messages();

} // namespace carrom

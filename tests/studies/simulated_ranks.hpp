// SPDX-License-Identifier: BSD-3-Clause
// Runs a function on all ranks of a simulated cluster. SimGrid (SMPI) stands in for the MPI library
// and the network, and all ranks take turns in this one process. What a rank computes takes no
// simulated time unless it calls `compute_for`, so that a run gives the same numbers on any
// machine.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace carrom {

struct SimulatedCluster {
    std::string platform; ///< an XML file with hosts node-0, node-1, ... of 1e9 operations a second
    int n_ranks = 1;
    int ranks_per_node = 1;     ///< they share the network card of their node
    double bytes_stand_for = 1; ///< a byte takes as long as this many of them
};

/// Calls `life(rank)` on each rank, between MPI_Init and MPI_Finalize. Takes SimGrid's own options
/// out of the command line.
void run_simulated(int& argc, char** argv, const SimulatedCluster& cluster,
                   const std::function<void(int)>& life);

/// The time of the calling rank goes on by this.
void compute_for(double nanoseconds);

/// Messages that have entered the network so far, those inside collective operations included.
std::uint64_t n_network_messages();

} // namespace carrom

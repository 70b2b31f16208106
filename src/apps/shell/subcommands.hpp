// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of `carrom`, except `run`, which is in run_command.hpp.
#pragma once

#include <cstdint>

#include "apps/shell/subcommand.hpp"

namespace carrom {

/// Runs independent replicas of one scene, each on one rank, and averages their results.
Subcommand replicas_subcommand();
/// Measures errors and costs of settings: runs a scene with many settings from the same initial
/// states, and writes a table for docs/tools/plot_accuracy.py.
Subcommand accuracy_subcommand();
/// Runs a scene on all ranks and compares the discs with lines of text from a file.
Subcommand compare_subcommand();
/// Prints the reference of scene keys to standard output.
Subcommand keys_subcommand();

/// Subcommands for files that runs write. Rank 0 reads most files, block by block; all ranks read
/// checkpoints. A single process needs no MPI for these subcommands.
Subcommand info_subcommand();
Subcommand verify_subcommand();
Subcommand diff_subcommand();
Subcommand convert_subcommand();

/// Largest number of rows of a file that are in memory at once.
inline constexpr std::uint64_t rows_at_a_time = std::uint64_t{1} << 16;

inline constexpr const char* help_of_file = "A checkpoint, a trajectory or a log of collisions";

} // namespace carrom

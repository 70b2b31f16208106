// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of `carrom`, except `run`, which is in run_command.hpp.
#pragma once

#include <cstdint>

#include "apps/shell/subcommand.hpp"

namespace carrom {

/// Independent runs of one scene, each on a rank of its own, and their averages.
Subcommand replicas_subcommand();
/// Measures errors and costs of settings: runs a scene with many settings from the
/// same starts. Writes a table, which docs/tools/plot_accuracy.py draws.
Subcommand accuracy_subcommand();
/// Reads a scene and lines of text, and runs the scene on all ranks.
Subcommand compare_subcommand();
/// The reference of scene keys, on standard output.
Subcommand keys_subcommand();

/// Prints the contents of files that runs write. Rank 0 reads, block by block; all
/// ranks read checkpoints. A process alone needs no MPI for any of them.
Subcommand info_subcommand();
Subcommand verify_subcommand();
Subcommand diff_subcommand();
Subcommand convert_subcommand();

/// The number of rows that are read at a time.
inline constexpr std::uint64_t rows_at_a_time = std::uint64_t{1} << 16;

inline constexpr const char* help_of_file = "A checkpoint, a trajectory or a log of collisions";

} // namespace carrom

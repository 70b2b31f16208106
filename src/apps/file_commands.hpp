// SPDX-License-Identifier: BSD-3-Clause
// `carrom info|verify|convert|diff`: what is in the files that runs write. Rank 0 reads, block by
// block; all ranks read checkpoints. A lone process needs no MPI for any of them.
#pragma once

#include <cstdint>

#include "apps/subcommand.hpp"

namespace carrom {

Subcommand info_subcommand();
Subcommand verify_subcommand();
Subcommand diff_subcommand();
Subcommand convert_subcommand();
/// Reads a scene and lines of text, and runs the scene on all ranks.
Subcommand compare_subcommand();

/// Rows that are read at a time.
inline constexpr std::uint64_t rows_at_a_time = std::uint64_t{1} << 16;

inline constexpr const char* help_of_file = "A checkpoint, a trajectory or a log of collisions";

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// `carrom run` simulates a scene to its last step. It prints lines of discs to standard output, and
// a summary at the end.
#pragma once

#include "apps/run_command/command_options.hpp"
#include "apps/shell/subcommand.hpp"

namespace carrom {

/// Runs a scene with all its outputs. `problems` of the command line and problems of the scene are
/// thrown together. **Collective.**
ExitCode run_scene(RunOptions options, const std::vector<Problem>& problems,
                   const Communicator& ranks);

Subcommand run_subcommand();

} // namespace carrom

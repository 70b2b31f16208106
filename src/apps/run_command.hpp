// SPDX-License-Identifier: BSD-3-Clause
// `carrom run`: from a scene to its last step, with its lines on standard output and a summary at
// the end.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/command_line.hpp"

namespace carrom {

/// Declares the subcommand; when `app` has parsed one, `action` is to run it.
void add_run_command(CLI::App& app, Action& action);

} // namespace carrom

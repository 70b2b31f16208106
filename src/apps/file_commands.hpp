// SPDX-License-Identifier: BSD-3-Clause
// `carrom info|verify|convert|diff`: what is in the files that runs write.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/command_line.hpp"

namespace carrom {

/// Declares the subcommands; when `app` has parsed one, `action` is to run it.
void add_file_commands(CLI::App& app, Action& action);

} // namespace carrom

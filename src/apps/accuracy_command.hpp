// SPDX-License-Identifier: BSD-3-Clause
// `carrom accuracy`: how wrong is a setting, and how long does it take? Runs a scene under many
// settings from the same starts and writes a table; docs/tools/plot_accuracy.py draws it.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/command_line.hpp"

namespace carrom {

/// Declares the subcommand on `app`; parsing it puts the work into `action`.
void add_accuracy_command(CLI::App& app, Action& action);

} // namespace carrom

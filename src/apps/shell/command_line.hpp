// SPDX-License-Identifier: BSD-3-Clause
// Turns the command line into one action.
#pragma once

#include "apps/shell/subcommand.hpp"

namespace carrom {

/// Every rank has the same command line and gets the same action. Help, version and
/// wrong command lines are actions, too. Starts nothing; not collective.
Action parse_command_line(int argc, char** argv);

} // namespace carrom

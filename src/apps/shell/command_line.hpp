// SPDX-License-Identifier: BSD-3-Clause
// From the command line to the one thing to do.
#pragma once

#include "apps/shell/subcommand.hpp"

namespace carrom {

/// Every rank has the same command line and comes to the same action. Help, version and wrong
/// command lines are actions too. Starts nothing; not collective.
Action parse_command_line(int argc, char** argv);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Turns the command line into one action.
#pragma once

#include "apps/shell/subcommand.hpp"

namespace carrom {

/// Every rank gets the same command line and so the same action. Help, version and errors of the
/// command line are actions, too. Does not start MPI; not collective.
Action parse_command_line(int argc, char** argv);

} // namespace carrom

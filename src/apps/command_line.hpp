// SPDX-License-Identifier: BSD-3-Clause
// From the command line to the one thing to do. Each subcommand declares its options and hands back
// an action.
//
// A new subcommand is a file with an `add_..._command` function and one line in command_line.cpp.
#pragma once

#include <functional>

#include "core/errors.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

/// What a command line asks for; every rank runs it. **Collective.**
using Action = std::function<ExitCode(const Communicator&)>;

/// Every rank has the same command line and comes to the same action. Throws InputError on every
/// rank. Help and version are actions too: rank 0 prints them.
Action parse_command_line(int argc, char** argv);

} // namespace carrom

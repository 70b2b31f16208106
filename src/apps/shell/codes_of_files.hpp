// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of the subcommands that judge files. Runs and the library never end with them.
#pragma once

#include "core/errors.hpp"

namespace carrom {

/// A file has no checksums, so nobody knows whether it is whole.
inline constexpr ExitCode no_checksums{5};
/// No fault was found in what is there, and something is missing: a log has a gap, or a step could
/// not be graded.
inline constexpr ExitCode incomplete{6};

} // namespace carrom

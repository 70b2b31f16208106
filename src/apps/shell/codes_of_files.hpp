// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of the subcommands that judge files. Runs and the library never return them.
#pragma once

#include "core/errors.hpp"

namespace carrom {

/// A file has no checksums, so it is unknown whether it is undamaged.
inline constexpr ExitCode no_checksums{5};
/// No fault was found, but something is missing: a log has a gap, or a step could not
/// be graded.
inline constexpr ExitCode incomplete{6};

} // namespace carrom

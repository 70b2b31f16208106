// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of the subcommands that check files. Runs and the library do not use them.
#pragma once

#include "core/errors.hpp"

namespace carrom {

/// The file has no checksums, so damage cannot be detected.
inline constexpr ExitCode no_checksums{5};
/// No fault was found, but the check is incomplete: a log has a gap, or a step could not be
/// compared.
inline constexpr ExitCode incomplete{6};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of the subcommands that judge files. Runs and the library never end with them.
#pragma once

#include "core/errors.hpp"

namespace carrom {

/// A file has no checksums, so nobody knows whether it is whole.
inline constexpr ExitCode no_checksums{5};
/// An output has no mistake as far as it could be graded, and could not be graded to its end.
inline constexpr ExitCode not_graded{6};

} // namespace carrom

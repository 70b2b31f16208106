// SPDX-License-Identifier: BSD-3-Clause
// The options of `carrom run`. Each is checked, so that one message lists all wrong options.
#pragma once

#include <vector>

#include "apps/shell/subcommand.hpp"
#include "core/errors.hpp"
#include "run/start/run_options.hpp"

namespace carrom {

/// The options of `carrom run`. Their values are stored in `run`, which must outlive the options.
std::vector<Option> run_options(RunOptions& run);

/// Adds an override for each option that sets a key, such as --steps, and appends problems of
/// options that exclude each other. Call it when all options have been read.
RunOptions completed(RunOptions options, std::vector<Problem>& problems);

} // namespace carrom

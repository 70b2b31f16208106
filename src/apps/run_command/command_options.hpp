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

/// Adds the settings of keys that have an option of their own, and appends problems of options that
/// exclude each other. Call it when all options are read.
RunOptions completed(RunOptions options, std::vector<Problem>& problems);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The options of `carrom run`, checked one by one so that all wrong ones are printed at once.
#pragma once

#include <vector>

#include "apps/shell/subcommand.hpp"
#include "core/errors.hpp"
#include "run/start/run_options.hpp"

namespace carrom {

/// The options of `carrom run`. They set `run`, which must live as long.
std::vector<Option> run_options(RunOptions& run);

/// Completes the options when all are read. `overrides` are the options that set a key. Appends
/// problems of options that exclude each other.
RunOptions completed(RunOptions options, std::vector<Problem>& problems);

} // namespace carrom

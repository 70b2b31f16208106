// SPDX-License-Identifier: BSD-3-Clause
// The options of `carrom run`, checked one by one so that all wrong ones are printed at once.
#pragma once

#include <vector>

#include "apps/shell/subcommand.hpp"
#include "core/errors.hpp"
#include "run/start/run_options.hpp"

namespace carrom {

/// The options of `carrom run`, which set `run`; it must live as long.
std::vector<Option> run_options(RunOptions& run);

/// The same once all options are there, with `overrides` for those that set a key. Appends what
/// does not go together to `problems`.
RunOptions completed(RunOptions options, std::vector<Problem>& problems);

} // namespace carrom

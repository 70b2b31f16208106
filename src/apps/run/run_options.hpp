// SPDX-License-Identifier: BSD-3-Clause
// The options of `carrom run`, checked one by one so that all wrong ones are printed at once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/shell/subcommand.hpp"
#include "core/errors.hpp"
#include "engine/tuning.hpp"

namespace carrom {

struct RunOptions {
    static constexpr int round_trip_digits = 17;

    std::string input;      ///< a file's name, or "-" for standard input
    std::string restart;    ///< a checkpoint, a folder of them, or "latest"; empty for a fresh run
    bool resume = false;    ///< go on in the folder of `output.folder`
    bool overwrite = false; ///< begin anew in a folder that has a run
    std::vector<std::string> overrides; ///< key=value, over what the input says

    int digits = round_trip_digits;
    std::string output; ///< a file for the lines of text; empty for standard output
    std::string report; ///< empty for none
    std::string folder; ///< as the command line names it; also among the overrides
    bool quiet = false;
    bool check = false; ///< hold every step to its invariants

    std::optional<int> threads;
    std::optional<std::int64_t> steps; ///< also among the overrides
    std::optional<double> accuracy;    ///< also among the overrides
    Tuning tuning;                     ///< but for `threads`, which needs to know the machine
};

/// The options of `carrom run`, which set `run`; it must live as long.
std::vector<Option> run_options(RunOptions& run);

/// The same once all options are there, with `overrides` for those that set a key. Appends what
/// does not go together to `problems`.
RunOptions completed(RunOptions options, std::vector<Problem>& problems);

} // namespace carrom

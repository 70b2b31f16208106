// SPDX-License-Identifier: BSD-3-Clause
// The options of a run that are not in its scene: where it starts, where it writes, and how many
// threads it has.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/tuning.hpp"
#include "run/messages.hpp"

namespace carrom {

struct RunOptions {
    static constexpr int round_trip_digits = 17;

    std::string input; ///< path of a file, or "-" for standard input
    /// Path of a checkpoint or of a folder of checkpoints, or "latest"; empty for a run from step 0
    std::string restart;
    bool resume = false;                ///< continue the run in `output.folder`
    bool overwrite = false;             ///< start at step 0 in a folder that has a run
    std::vector<std::string> overrides; ///< settings key=value that replace those of the input

    int digits = round_trip_digits;
    std::string output; ///< path for the lines of text; empty for standard output
    std::string report; ///< path of a report; empty for none
    std::string folder; ///< output folder of the command line, which is also among the overrides
    bool quiet = false;
    bool gpu = false;   ///< GPU flag of the command line, which is also among the overrides
    bool check = false; ///< check the invariants at every step

    std::optional<int> threads;
    std::optional<std::int64_t> steps; ///< steps of the command line, also among the overrides
    std::optional<double> accuracy;    ///< accuracy of the command line, also among the overrides
    Tuning tuning; ///< all settings except the number of threads, which `threads` sets
    Messages messages;
};

/// Whether an option requests that the run continue from a checkpoint.
inline bool goes_on(const RunOptions& options) {
    return options.resume || !options.restart.empty();
}

} // namespace carrom

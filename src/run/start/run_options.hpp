// SPDX-License-Identifier: BSD-3-Clause
// The options of a run beside its scene: where it starts, where it writes, and how
// many threads it has.
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

    std::string input;      ///< a file's name, or "-" for standard input
    std::string restart;    ///< a checkpoint, a folder of them, or "latest"; empty for a fresh run
    bool resume = false;    ///< go on in the folder of `output.folder`
    bool overwrite = false; ///< begin anew in a folder that has a run
    std::vector<std::string> overrides; ///< key=value, over what the input says

    int digits = round_trip_digits;
    std::string output; ///< a file for the lines of text; empty for standard output
    std::string report; ///< empty for none
    std::string folder; ///< by the command line; also among the overrides
    bool quiet = false;
    bool gpu = false;   ///< by the command line; also among the overrides
    bool check = false; ///< hold every step to its invariants

    std::optional<int> threads;
    std::optional<std::int64_t> steps; ///< also among the overrides
    std::optional<double> accuracy;    ///< also among the overrides
    Tuning tuning;                     ///< without `threads`, which depends on the machine
    Messages messages;
};

/// Whether the run goes on from a checkpoint, if there is one.
inline bool goes_on(const RunOptions& options) {
    return options.resume || !options.restart.empty();
}

} // namespace carrom

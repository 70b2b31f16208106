// SPDX-License-Identifier: BSD-3-Clause
// The options of `carrom run`, checked one by one so that all wrong ones can be told at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/errors.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

struct RunOptions {
    static constexpr int round_trip_digits = 17;

    std::string input; ///< a file's name, or "-" for standard input
    std::string
        restart; ///< a checkpoint, a folder of them, or "latest"; empty for a run from its start
    std::vector<std::string> overrides; ///< key=value, over what the input says
    int digits = round_trip_digits;
    std::string output; ///< a file for the lines of text; empty for standard output
    std::string report; ///< empty for none
    bool quiet = false;
    bool check = false; ///< hold every step to its invariants
    std::optional<int> threads;
    Tuning tuning; ///< but for `threads`, which needs to know the machine
};

/// The words of the command line as they stand.
struct RunWords {
    std::string input, restart, threads, steps, accuracy, digits, output, report;
    std::string window, cell_width, rebalance_every, rebalance_above;
    std::vector<std::string> overrides;
    bool quiet = false, check = false;
};

/// A flag that takes no value: `NAME=no` would else be read as its opposite, and any other value as
/// none.
CLI::Option* add_switch(CLI::App& command, const std::string& name, bool& is_on,
                        const std::string& what_it_does);

/// Declares the options on `command`. `words` must live until it has parsed.
void declare_run_options(CLI::App& command, RunWords& words);

/// Appends what is wrong with the words to `problems`.
RunOptions checked_run_options(const RunWords& words, std::vector<Problem>& problems);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_options.hpp"

#include <limits>

#include <fmt/format.h>

#include "apps/number_words.hpp"

namespace carrom {

std::vector<Option> run_options(RunWords& words) {
    constexpr const char* costs = "Cost only, never bits";
    return {
        {"INPUT", "", "SCENE.toml, FILE.in, or - for standard input", &words.input},
        {"--threads", "T",
         "Threads per rank; default OMP_NUM_THREADS if set, else this rank's share of the cores",
         &words.threads},
        {"-o,--folder", "FOLDER",
         "The folder for all that the run writes, instead of output.folder", &words.folder},
        {"--resume", "",
         "Go on with the run of that folder, from its newest whole checkpoint; INPUT may be left "
         "out",
         &words.resume},
        {"--overwrite", "", "Begin anew in a folder that has a run: remove what it has written",
         &words.overwrite},
        {"--restart", "FILE|FOLDER|latest",
         "Go on from a checkpoint: a FILE, a FOLDER (its newest whole one), or `latest` in the "
         "scene's folder; INPUT may be left out with FILE and FOLDER",
         &words.restart},
        {"--steps", "S", "The last step, counted from the scene's start, instead of the input's",
         &words.steps},
        {"--accuracy", "X",
         "Let a short pilot choose the fastest method and micro-steps whose collision rate and "
         "pressure are within this share of the truth",
         &words.accuracy},
        {"--set", "KEY=VALUE", "Set any scene key, as in --set time.steps=100; may be repeated",
         &words.overrides},
        {"--digits", "D",
         "17 (the default): 17 significant digits, which read back as the same bits; 1 to 16: "
         "that many decimals (8 gives the course program's look)",
         &words.digits},
        {"--output", "FILE",
         "Write the lines to FILE, not to standard output (under mpirun only so a full disk is "
         "noticed)",
         &words.output},
        {"--report", "FILE", "Write the summary's numbers to FILE as JSON", &words.report},
        {"--quiet", "", "No progress and no summary; errors and warnings are still printed",
         &words.quiet},
        {"--check", "",
         "After every step check the state's invariants; a broken one ends the run with code 70 "
         "and leaves a scene of the discs around it",
         &words.check},
        {"--window", "W",
         "Micro-steps per window; below 1 a micro-step is cut into parts, at most 100000",
         &words.window, false, costs},
        {"--cell-width", "C", "Width of a cell, in reaches of the window", &words.cell_width, false,
         costs},
        {"--rebalance-every", "K", "Syncs between looks at the load; 0 keeps the first strips",
         &words.rebalance_every, false, costs},
        {"--rebalance-above", "X",
         "Largest over mean load that is tolerated; 0 moves the cuts at every look",
         &words.rebalance_above, false, costs},
    };
}

RunOptions checked_run_options(const RunWords& words, std::vector<Problem>& problems) {
    constexpr double largest = std::numeric_limits<double>::max();
    constexpr auto unbounded = std::numeric_limits<std::int64_t>::max();
    const auto number = [&problems](const char* option, const std::string& word, auto least,
                                    auto most, const char* why = "") {
        return number_of(option, word, least, most, problems, why);
    };
    RunOptions options;
    options.input = words.input;
    options.restart = words.restart;
    options.overrides = words.overrides;
    options.output = words.output;
    options.report = words.report;
    options.quiet = words.quiet;
    options.check = words.check;
    options.folder = words.folder;
    options.resume = words.resume;
    options.overwrite = words.overwrite;
    if (!words.folder.empty()) options.overrides.push_back("output.folder=" + words.folder);
    if (words.resume && !words.restart.empty())
        problems.push_back({"--resume", 0, "takes the newest checkpoint; leave --restart out"});
    if (words.overwrite && (words.resume || !words.restart.empty()))
        problems.push_back({"--overwrite", 0, "begins anew; leave --resume and --restart out"});
    options.threads = number("--threads", words.threads, 1, 1024);
    options.digits =
        number("--digits", words.digits, 1, RunOptions::round_trip_digits).value_or(options.digits);
    if (const auto accuracy = number("--accuracy", words.accuracy, least_above_0, largest))
        options.overrides.push_back(fmt::format("time.accuracy={}", *accuracy));
    if (const auto steps = number("--steps", words.steps, std::int64_t{0}, unbounded))
        options.overrides.push_back(fmt::format("time.steps={}", *steps));
    Tuning& tuning = options.tuning;
    tuning.window = number("--window", words.window, 1e-5, largest,
                           " (a hundred thousand windows to a micro-step)");
    tuning.cell_width = number("--cell-width", words.cell_width, least_above_0, largest);
    tuning.rebalance_every = number("--rebalance-every", words.rebalance_every, std::int64_t{0},
                                    unbounded)
                                 .value_or(tuning.rebalance_every);
    tuning.rebalance_above = number("--rebalance-above", words.rebalance_above, 0.0, largest)
                                 .value_or(tuning.rebalance_above);
    return options;
}

} // namespace carrom

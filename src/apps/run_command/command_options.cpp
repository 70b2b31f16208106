// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_command/command_options.hpp"

#include <limits>

#include <fmt/format.h>

#include "apps/shell/number_words.hpp"
#include "scene/overrides.hpp"

namespace carrom {

namespace {
constexpr auto unbounded = std::numeric_limits<std::int64_t>::max();
} // namespace

std::vector<Option> run_options(RunOptions& run) {
    constexpr const char* costs = "Cost only, never bits";
    return {
        {"INPUT", "", "SCENE.toml, FILE.in, or - for standard input", &run.input},
        {"--threads", "T",
         "Threads per rank; default OMP_NUM_THREADS if set, else this rank's share of the cores",
         number(run.threads, 1, 1024)},
        {"--gpu", "", "Step the discs on a GPU, with the same bits: machine.gpu=true", &run.gpu},
        {"-o,--folder", "FOLDER",
         "The folder for all that the run writes, instead of output.folder", &run.folder},
        {"--resume", "",
         "Go on with the run of that folder, from its newest whole checkpoint; INPUT may be left "
         "out",
         &run.resume},
        {"--overwrite", "", "Begin anew in a folder that has a run: remove what it has written",
         &run.overwrite},
        {"--restart", "FILE|FOLDER|latest",
         "Go on from a checkpoint: a FILE, a FOLDER (its newest whole one), or `latest` in the "
         "scene's folder; INPUT may be left out with FILE and FOLDER",
         &run.restart},
        {"--steps", "S", "The last step, counted from the scene's start, instead of the input's",
         number(run.steps, std::int64_t{0}, unbounded)},
        {"--accuracy", "X",
         "Let a short pilot choose the fastest method and micro-steps whose collision rate and "
         "pressure are within this share of the truth",
         number(run.accuracy, least_above_0, largest_double)},
        {"--set", "KEY=VALUE", "Set any scene key, as in --set time.steps=100; may be repeated",
         &run.overrides},
        {"--digits", "D",
         "17 (the default): 17 significant digits, which read back as the same bits; 1 to 16: "
         "that many decimals (8 gives the course program's look)",
         number(run.digits, 1, RunOptions::round_trip_digits)},
        {"--output", "FILE",
         "Write the lines to FILE, not to standard output (under mpirun only so a full disk is "
         "noticed)",
         &run.output},
        {"--report", "FILE", "Write the summary's numbers to FILE as JSON", &run.report},
        {"--quiet", "", "No progress and no summary; errors and warnings are still printed",
         &run.quiet},
        {"--check", "",
         "After every step check the state's invariants; a broken one ends the run with code 70 "
         "and leaves a scene of the discs around it",
         &run.check},
        {"--window", "W",
         "Micro-steps per window; below 1 a micro-step is cut into parts, at most 100000",
         number(run.tuning.window, 1e-5, largest_double,
                " (a hundred thousand windows to a micro-step)"),
         false, costs},
        {"--cell-width", "C", "Width of a cell, in reaches of the window",
         number(run.tuning.cell_width, least_above_0, largest_double), false, costs},
        {"--ranks-across", "G", "Ranks that share a strip; default 1, and more of narrow strips",
         number(run.tuning.ranks_across, 1, 1000000), false, costs},
        {"--rebalance-every", "K",
         "Syncs between inspections of the load; 0 keeps the first domains",
         number(run.tuning.rebalance_every, std::int64_t{0}, unbounded), false, costs},
        {"--rebalance-above", "X",
         "Largest over mean load that is tolerated; 0 moves the cuts at every inspection",
         number(run.tuning.rebalance_above, 0.0, largest_double), false, costs},
    };
}

namespace {

/// Removes `KEY` and appends a problem if the user wrote `--set KEY VALUE` instead of KEY=VALUE.
/// VALUE is then an extra word, which is an error before the scene is read.
void take_out_keys_alone(std::vector<std::string>& overrides, std::vector<Problem>& problems) {
    std::erase_if(overrides, [&problems](const std::string& text) {
        const bool is_alone = !text.empty() && text.find('=') == std::string::npos;
        if (is_alone) problems.push_back({"--set " + text, 0, form_problem(text)});
        return is_alone;
    });
}

} // namespace

RunOptions completed(RunOptions options, std::vector<Problem>& problems) {
    const auto set = [&options](const char* key, const auto& value) {
        options.overrides.push_back(fmt::format("{}={}", key, value));
    };
    take_out_keys_alone(options.overrides, problems);
    if (!options.folder.empty()) set("output.folder", options.folder);
    if (options.gpu) set("machine.gpu", true);
    if (options.accuracy) set("time.accuracy", *options.accuracy);
    if (options.steps) set("time.steps", *options.steps);
    if (options.resume && !options.restart.empty())
        problems.push_back({"--resume", 0, "takes the newest checkpoint; leave --restart out"});
    if (options.overwrite && (options.resume || !options.restart.empty()))
        problems.push_back({"--overwrite", 0, "begins anew; leave --resume and --restart out"});
    return options;
}

} // namespace carrom

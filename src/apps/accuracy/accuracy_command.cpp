// SPDX-License-Identifier: BSD-3-Clause
#include "apps/shell/subcommands.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>

#include "apps/accuracy/accuracy_study.hpp"
#include "apps/run_command/command_options.hpp"
#include "apps/shell/number_words.hpp"
#include "apps/shell/standard_streams.hpp"
#include "run/files/destinations.hpp"
#include "run/start/load.hpp"

namespace carrom {

namespace {

constexpr const char* accuracy_footer =
    R"(Every setting is run from the same starts: discs that the event-driven method has brought to
equilibrium. Starts are made from different seeds; discs that are listed are run on for longer and
longer. FILE is a new table; it gets a line for each trial as soon as it is done. To share the work
out (a Slurm array), or to lose less when it is stopped: --share 1/8 ... --share 8/8, each with a
FILE of its own.

Examples:
  carrom accuracy inputs/gas.toml --set discs.count=2000 --output gas.csv
  carrom accuracy inputs/gas.toml --micro-steps 16 --arithmetic default --starts 4 --output gas.csv
  carrom accuracy inputs/gas.toml --distances --collisions 30 --output distances.csv
  python3 docs/tools/plot_accuracy.py gas.csv --output gas)";

struct AccuracyOptions {
    RunOptions run;
    StudyOptions study;
    bool of_distances = false;
    std::string share, arithmetic = "all"; ///< the options' values as the user wrote them
};

constexpr int most = 1000000;

ExitCode study(const AccuracyOptions& options, std::vector<Problem> problems,
               const Communicator& ranks) {
    if (ranks.size() > 1)
        problems.push_back({"carrom accuracy", 0,
                            "runs on one rank; share the work out with --share instead of mpirun"});
    const auto of_table = problems_with({{"--output", options.study.table, Output::table}},
                                        {{"the input", options.run.input}});
    problems.insert(problems.end(), of_table.begin(), of_table.end());
    RunOptions run = options.run;
    run.messages = messages_of(ranks, run.quiet);
    Loaded loaded = load(run, problems, ranks);
    if (loaded.scene.effects.are_any())
        throw InputError(
            {{loaded.scene.name, 0,
              "errors are known for scenes without effects only, and this one has '[effects]'"}});
    (options.of_distances ? study_distances : study_costs)(loaded.scene, loaded.start.discs,
                                                           options.study, ranks);
    return ExitCode::success;
}

AccuracyOptions completed(AccuracyOptions options, std::vector<Problem>& problems) {
    options.run = completed(options.run, problems);
    StudyOptions& study = options.study;
    study.quiet = options.run.quiet;
    if (options.arithmetic == "default")
        study.formulas = Formulas::usual;
    else if (options.arithmetic == "stable")
        study.formulas = Formulas::stable;
    else if (options.arithmetic != "all")
        problems.push_back(
            {"--arithmetic", 0,
             fmt::format("must be all, stable or default, not \"{}\"", options.arithmetic)});
    const std::string& share = options.share;
    if (const std::size_t slash = share.find('/'); slash != std::string::npos) {
        number(study.share, 1, most)("--share", share.substr(0, slash), problems);
        number(study.n_shares, 1, most)("--share", share.substr(slash + 1), problems);
    }
    if (!share.empty() && (share.find('/') == std::string::npos || study.share > study.n_shares))
        problems.push_back(
            {"--share", 0, fmt::format("must be K/N with K from 1 to N, not \"{}\"", share)});
    return options;
}

std::vector<Option> options_of(AccuracyOptions& options) {
    RunOptions& run = options.run;
    StudyOptions& study = options.study;
    return {
        {"INPUT", "", "SCENE.toml or FILE.in", &run.input, true},
        {"--output", "FILE", "The new table of CSV; default accuracy.csv", &study.table},
        {"--starts", "N", "Starts for each setting; default 8", number(study.n_starts, 1, most)},
        {"--repetitions", "R", "Of each trial, in turns, for its cost; default 3",
         number(study.n_repetitions, 1, most)},
        {"--collisions", "C", "Collisions of a disc with others per trial; default 100",
         number(study.collisions, 1e-3, double{most})},
        {"--approach", "C", "And before it, to come to equilibrium; default 20",
         number(study.approach, 1e-3, double{most})},
        {"--micro-steps", "K", "Largest K of 1, 2, 4, ...; default 256",
         number(study.most_micro_steps, std::int64_t{1}, std::int64_t{most})},
        {"--arithmetic", "all|stable|default",
         "all: both precisions and formulas; stable: both precisions; default: what runs use",
         &options.arithmetic},
        {"--distances", "",
         "Distances to the exact run along time, in the place of rates and costs; K = 1, 16, 256",
         &options.of_distances},
        {"--share", "K/N", "The K-th of N shares of the trials only", &options.share},
        {"--threads", "T", "Threads; default 1", number(study.threads, 1, 1024)},
        {"--set", "KEY=VALUE", "Set any scene key; may be repeated", &run.overrides},
        {"--quiet", "", "No progress", &run.quiet},
    };
}

} // namespace

Subcommand accuracy_subcommand() {
    const auto given = std::make_shared<AccuracyOptions>();
    const auto action = [given](std::vector<Problem>& problems) -> Action {
        AccuracyOptions options = completed(*given, problems);
        return {[options = std::move(options), problems](const Communicator& ranks) {
                    return study(options, problems, ranks);
                },
                true};
    };
    return {"accuracy", "Measure what accuracy costs: a scene under many settings", accuracy_footer,
            options_of(*given), action};
}

} // namespace carrom

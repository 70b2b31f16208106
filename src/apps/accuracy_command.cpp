// SPDX-License-Identifier: BSD-3-Clause
#include "apps/accuracy_command.hpp"

#include <memory>
#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "apps/accuracy_study.hpp"
#include "apps/load.hpp"
#include "apps/number_words.hpp"

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
};

ExitCode study(const AccuracyOptions& options, std::vector<Problem> problems,
               const Communicator& ranks) {
    if (ranks.size() > 1)
        problems.push_back({"carrom accuracy", 0,
                            "runs on one rank; share the work out with --share instead of mpirun"});
    Loaded loaded = load(options.run, problems, ranks);
    if (loaded.scene.effects.are_any())
        throw InputError(
            {{loaded.scene.name, 0,
              "errors are known for scenes without effects only, and this one has '[effects]'"}});
    (options.of_distances ? study_distances : study_costs)(loaded.scene, loaded.discs,
                                                           options.study, ranks);
    return ExitCode::success;
}

/// The words of the command line as they stand.
struct AccuracyWords {
    RunWords run;
    std::string table, starts, repetitions, collisions, approach, micro_steps, share, threads;
    std::string arithmetic = "all";
    bool of_distances = false;
};

AccuracyOptions checked(const AccuracyWords& words, std::vector<Problem>& problems) {
    AccuracyOptions options;
    options.run = checked_run_options(words.run, problems);
    options.of_distances = words.of_distances;
    StudyOptions& study = options.study;
    study.quiet = options.run.quiet;
    if (!words.table.empty()) study.table = words.table;
    constexpr int most = 1000000;
    const auto take = [&problems](auto& number, const char* option, const std::string& word,
                                  auto least, auto largest) {
        using Number = std::remove_reference_t<decltype(number)>;
        number = number_of<Number>(option, word, least, largest, problems).value_or(number);
    };
    take(study.n_starts, "--starts", words.starts, 1, most);
    take(study.n_repetitions, "--repetitions", words.repetitions, 1, most);
    take(study.collisions, "--collisions", words.collisions, 1e-3, most);
    take(study.approach, "--approach", words.approach, 1e-3, most);
    take(study.most_micro_steps, "--micro-steps", words.micro_steps, 1, most);
    take(study.threads, "--threads", words.threads, 1, 1024);
    if (words.arithmetic == "default")
        study.formulas = Formulas::usual;
    else if (words.arithmetic == "stable")
        study.formulas = Formulas::stable;
    else if (words.arithmetic != "all")
        problems.push_back(
            {"--arithmetic", 0,
             fmt::format("must be all, stable or default, not \"{}\"", words.arithmetic)});
    if (const std::size_t slash = words.share.find('/'); slash != std::string::npos) {
        take(study.share, "--share", words.share.substr(0, slash), 1, most);
        take(study.n_shares, "--share", words.share.substr(slash + 1), 1, most);
    }
    if (!words.share.empty() &&
        (words.share.find('/') == std::string::npos || study.share > study.n_shares))
        problems.push_back(
            {"--share", 0, fmt::format("must be K/N with K from 1 to N, not \"{}\"", words.share)});
    return options;
}

std::vector<Option> options_of(AccuracyWords& words) {
    return {
        {"INPUT", "", "SCENE.toml or FILE.in", &words.run.input, true},
        {"--output", "FILE", "The new table of CSV; default accuracy.csv", &words.table},
        {"--starts", "N", "Starts for each setting; default 8", &words.starts},
        {"--repetitions", "R", "Of each trial, in turns, for its cost; default 3",
         &words.repetitions},
        {"--collisions", "C", "Collisions of a disc with others per trial; default 100",
         &words.collisions},
        {"--approach", "C", "And before it, to come to equilibrium; default 20", &words.approach},
        {"--micro-steps", "K", "Largest K of 1, 2, 4, ...; default 256", &words.micro_steps},
        {"--arithmetic", "all|stable|default",
         "all: both precisions and formulas; stable: both precisions; default: what runs use",
         &words.arithmetic},
        {"--distances", "",
         "Distances to the exact run along time, in the place of rates and costs; K = 1, 16, 256",
         &words.of_distances},
        {"--share", "K/N", "The K-th of N shares of the trials only", &words.share},
        {"--threads", "T", "Threads; default 1", &words.threads},
        {"--set", "KEY=VALUE", "Set any scene key; may be repeated", &words.run.overrides},
        {"--quiet", "", "No progress", &words.run.quiet},
    };
}

} // namespace

Subcommand accuracy_subcommand() {
    const auto words = std::make_shared<AccuracyWords>();
    const auto action = [words](std::vector<Problem>& problems) -> Action {
        AccuracyOptions options = checked(*words, problems);
        return {[options = std::move(options), problems](const Communicator& ranks) {
                    return study(options, problems, ranks);
                },
                true};
    };
    return {"accuracy", "Measure what accuracy costs: a scene under many settings", accuracy_footer,
            options_of(*words), action};
}

} // namespace carrom

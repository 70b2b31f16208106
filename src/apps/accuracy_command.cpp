// SPDX-License-Identifier: BSD-3-Clause
#include "apps/accuracy_command.hpp"

#include <charconv>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "apps/accuracy_study.hpp"
#include "apps/load.hpp"

namespace carrom {

namespace {

constexpr const char* teaching =
    R"(Every setting is run from the same starts: discs that the event-driven method has brought to
equilibrium. Starts are made from different seeds; discs that are listed are run on for longer and longer.
FILE gets a line for each trial as soon as it is done, and a study that was stopped goes on with the
same command. To share it out (a Slurm array): --share 1/8 ... --share 8/8, each with a FILE of its own.

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
    std::string table, starts, repetitions, collisions, approach, micro_steps, arithmetic = "all",
                                                                               share, threads;
    bool of_distances = false;
};

/// A number of at least `least` where the word is given.
template <class Number>
void take(Number& number, const char* option, const std::string& word, Number least,
          std::vector<Problem>& problems, Number most = 1000000) {
    if (word.empty()) return;
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc{} && end == word.data() + word.size() && value >= least && value <= most)
        number = value;
    else
        problems.push_back(
            {option, 0,
             fmt::format("must be a number from {} to {}, not \"{}\"", least, most, word)});
}

AccuracyOptions checked(const AccuracyWords& words, std::vector<Problem>& problems) {
    AccuracyOptions options;
    options.run = checked_run_options(words.run, problems);
    options.of_distances = words.of_distances;
    StudyOptions& study = options.study;
    study.quiet = options.run.quiet;
    if (!words.table.empty()) study.table = words.table;
    take(study.n_starts, "--starts", words.starts, 1, problems);
    take(study.n_repetitions, "--repetitions", words.repetitions, 1, problems);
    take(study.collisions, "--collisions", words.collisions, 1e-3, problems);
    take(study.approach, "--approach", words.approach, 1e-3, problems);
    take(study.most_micro_steps, "--micro-steps", words.micro_steps, std::int64_t{1}, problems);
    take(study.threads, "--threads", words.threads, 1, problems, 1024);
    if (words.arithmetic == "default")
        study.formulas = Formulas::usual;
    else if (words.arithmetic == "stable")
        study.formulas = Formulas::stable;
    else if (words.arithmetic != "all")
        problems.push_back(
            {"--arithmetic", 0,
             fmt::format("must be all, stable or default, not \"{}\"", words.arithmetic)});
    if (const std::size_t slash = words.share.find('/'); slash != std::string::npos) {
        take(study.share, "--share", words.share.substr(0, slash), 1, problems);
        take(study.n_shares, "--share", words.share.substr(slash + 1), 1, problems);
    }
    if (!words.share.empty() &&
        (words.share.find('/') == std::string::npos || study.share > study.n_shares))
        problems.push_back(
            {"--share", 0, fmt::format("must be K/N with K from 1 to N, not \"{}\"", words.share)});
    return options;
}

} // namespace

void add_accuracy_command(CLI::App& app, Action& action) {
    auto words = std::make_shared<AccuracyWords>();
    CLI::App* command = app.add_subcommand(
        "accuracy", "Measure what accuracy costs: a scene under many settings");
    command->set_help_flag("-h,--help", "Print this help and exit");
    command->add_option("INPUT", words->run.input, "SCENE.toml or FILE.in")
        ->type_name("")
        ->required();
    command->add_option("--output", words->table, "The table of CSV; default accuracy.csv")
        ->type_name("FILE");
    command->add_option("--starts", words->starts, "Starts for each setting; default 8")
        ->type_name("N");
    command
        ->add_option("--repetitions", words->repetitions,
                     "Of each trial, in turns, for its cost; default 3")
        ->type_name("R");
    command
        ->add_option("--collisions", words->collisions,
                     "Collisions of a disc with others per trial; default 100")
        ->type_name("C");
    command
        ->add_option("--approach", words->approach,
                     "And before it, to come to equilibrium; default 20")
        ->type_name("C");
    command
        ->add_option("--micro-steps", words->micro_steps, "Largest K of 1, 2, 4, ...; default 256")
        ->type_name("K");
    command
        ->add_option(
            "--arithmetic", words->arithmetic,
            "all: both precisions and formulas; stable: both precisions; default: what runs use")
        ->type_name("all|stable|default");
    add_switch(
        *command, "--distances", words->of_distances,
        "Distances to the exact run along time, in the place of rates and costs; K = 1, 16, 256");
    command->add_option("--share", words->share, "The K-th of N shares of the trials only")
        ->type_name("K/N");
    command->add_option("--threads", words->threads, "Threads; default 1")->type_name("T");
    command->add_option("--set", words->run.overrides, "Set any scene key; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    add_switch(*command, "--quiet", words->run.quiet, "No progress");
    command->footer(teaching);
    command->callback([words, &action] {
        std::vector<Problem> problems;
        AccuracyOptions options = checked(*words, problems);
        action = [options = std::move(options), problems = std::move(problems)](
                     const Communicator& ranks) { return study(options, problems, ranks); };
    });
}

} // namespace carrom

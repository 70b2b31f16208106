// SPDX-License-Identifier: BSD-3-Clause
#include "accuracy_command.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "accuracy_table.hpp"
#include "carrom/simulation/initial_state.hpp"
#include "load.hpp"
#include "stop_signals.hpp"
#include "stopwatch.hpp"

namespace carrom {

namespace {

constexpr const char* teaching = R"(Every setting is run from the same starts: discs that the exact rule has brought to
equilibrium. Starts are made from different seeds; discs that are listed are run on for longer and longer.
FILE gets a line for each trial as soon as it is done, and a study that was stopped goes on with the
same command. To share it out (a Slurm array): --share 1/8 ... --share 8/8, each with a FILE of its own.

Examples:
  carrom accuracy inputs/gas.toml --set discs.count=2000 --output gas.csv
  carrom accuracy inputs/gas.toml --micro-steps 16 --arithmetic default --starts 4 --output gas.csv
  python3 docs/tools/plot_accuracy.py gas.csv -o gas)";

struct AccuracyOptions {
    RunOptions run;
    std::string table = "accuracy.csv";
    int n_starts = 8, share = 1, n_shares = 1, threads = 1;
    double collisions = 100, approach = 20;
    std::int64_t most_micro_steps = 256;
    bool default_arithmetic_only = false;
};

std::vector<RunSetting> settings_of(const AccuracyOptions& options) {
    std::vector<RunSetting> settings{{CollisionRule::all}};
    for (std::int64_t k = 1; k <= options.most_micro_steps; k *= 2) {
        for (const Precision precision : {Precision::double_, Precision::single}) {
            settings.push_back({CollisionRule::one, k, precision});
            if (options.default_arithmetic_only) break;
            settings.push_back({CollisionRule::one, k, precision, Arithmetic::naive, false});
            settings.push_back({CollisionRule::one, k, precision, Arithmetic::naive, true});
        }
    }
    return settings;
}

/// Independent starts: other seeds where discs are generated, else the same discs after more and more collisions.
TrialStart make_start(const Scene& scene, const std::vector<InputDisc>& discs, int number, const AccuracyOptions& options,
                      const Communicator& ranks, const Tuning& tuning) {
    if (scene.generator == Generator::file) return bring_to_equilibrium(scene, discs, options.approach * (number + 1), ranks, tuning);
    Scene other = scene;
    other.seed += static_cast<std::uint64_t>(number);
    return bring_to_equilibrium(other, initial_state(other, nullptr, ranks), options.approach, ranks, tuning);
}

Distance distance_between(const std::vector<InputDisc>& a, const std::vector<InputDisc>& b, double diameter) {
    std::vector<double> squares;
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double dx = a[i].x - b[i].x, dy = a[i].y - b[i].y;
        squares.push_back(dx * dx + dy * dy);
        sum += squares.back();
    }
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::nth_element(squares.begin(), middle, squares.end());
    return {std::sqrt(sum / static_cast<double>(a.size())) / diameter, std::sqrt(*middle) / diameter};
}

/// What is left to do, as time goes on. Costs are in the micro-steps of a start, about.
class StudyProgress {
public:
    StudyProgress(double all, bool wanted) : all_(all), wanted_(wanted), on_terminal_(isatty(STDERR_FILENO) == 1) {}
    ~StudyProgress() {
        if (wanted_ && on_terminal_) fmt::print(stderr, "\n");
    }
    StudyProgress(const StudyProgress&) = delete;
    StudyProgress& operator=(const StudyProgress&) = delete;

    /// `measured` is false for what was there already.
    void show(double cost, bool measured) {
        (measured ? done_ : found_) += cost;
        since_shown_ += watch_lap();
        if (!wanted_ || !measured || since_shown_ < (on_terminal_ ? 0.2 : 20)) return;
        since_shown_ = 0;
        const auto left = static_cast<std::int64_t>(seconds_ * (all_ - found_ - done_) / done_ + 0.5);
        fmt::print(stderr, "{}accuracy: {:.1f} % done, {}:{:02}:{:02} left{}", on_terminal_ ? "\r" : "", 100 * (found_ + done_) / all_,
                   left / 3600, left / 60 % 60, left % 60, on_terminal_ ? "\x1b[K" : "\n");
        std::fflush(stderr);
    }

private:
    double watch_lap() {
        const double lap = watch_.lap();
        seconds_ += lap;
        return lap;
    }

    double all_, done_ = 0, found_ = 0, seconds_ = 0, since_shown_ = 1e9;
    bool wanted_, on_terminal_;
    Stopwatch watch_;
};

double cost_of(const RunSetting& setting) { return static_cast<double>(setting.micro_steps) + 4; }

bool is_in_share(const AccuracyOptions& options, const std::vector<RunSetting>& settings, int number, std::size_t k) {
    const std::size_t item = static_cast<std::size_t>(number) * settings.size() + k;
    return item % static_cast<std::size_t>(options.n_shares) == static_cast<std::size_t>(options.share - 1);
}

/// Of this process's trials from that start; 0 if there are none.
double cost_of_share(const AccuracyOptions& options, const std::vector<RunSetting>& settings, int number) {
    double cost = 0;
    for (std::size_t k = 0; k < settings.size(); ++k)
        if (is_in_share(options, settings, number, k)) cost += cost_of(settings[k]);
    return cost;
}

/// The trials of one start that are this process's share.
void study_start(const Scene& scene, const std::vector<InputDisc>& discs, int number, const std::vector<RunSetting>& settings,
                 const AccuracyOptions& options, AccuracyTable& table, StudyProgress& progress, const Communicator& ranks) {
    if (cost_of_share(options, settings, number) == 0) return;
    Tuning tuning;
    tuning.threads = options.threads;
    const TrialStart start = make_start(scene, discs, number, options, ranks, tuning);
    TrialLength length;
    length.steps = std::max<std::int64_t>(1, std::llround(options.collisions / start.frequency));
    length.early_step = std::clamp<std::int64_t>(std::llround(1 / start.frequency), 1, length.steps);
    std::optional<Trial> exact; // as far as the early step
    for (std::size_t k = 0; k < settings.size(); ++k) {
        if (!is_in_share(options, settings, number, k)) continue;
        const TrialKey key{number, settings[k], length};
        const bool is_new = !table.has(scene, start, key);
        if (is_new && !exact) exact = run_trial(scene, settings[0], start, {length.early_step, length.early_step, 1}, ranks, tuning);
        if (is_new) {
            try {
                const Trial trial = run_trial(scene, settings[k], start, length, ranks, tuning);
                table.add(scene, start, key, trial, distance_between(trial.early, exact->early, 2 * scene.radius), options.threads);
            } catch (const InputError& error) {
                table.add_failure(scene, start, key, error.problems().front().text, options.threads);
            }
        }
        progress.show(cost_of(settings[k]), is_new);
    }
}

ExitCode study(const AccuracyOptions& options, std::vector<Problem> problems, const Communicator& ranks) {
    if (ranks.size() > 1) problems.push_back({"carrom accuracy", 0, "runs on one rank; share the work out with --share instead of mpirun"});
    StopSignals signals;
    signals.let_go(); // nothing to store: each line of the table is whole
    Loaded loaded = load(options.run, problems, signals, ranks);
    AccuracyTable table(options.table);
    const std::vector<RunSetting> settings = settings_of(options);
    double cost = 0;
    for (int number = 0; number < options.n_starts; ++number) cost += cost_of_share(options, settings, number);
    StudyProgress progress(cost, !options.run.quiet);
    for (int number = 0; number < options.n_starts; ++number)
        study_start(loaded.scene, loaded.discs, number, settings, options, table, progress, ranks);
    return ExitCode::success;
}

/// The words of the command line as they stand.
struct AccuracyWords {
    RunWords run;
    std::string table, starts, collisions, approach, micro_steps, arithmetic = "all", share, threads;
};

/// A number of at least `least` where the word is given.
template <class Number>
void take(Number& number, const char* option, const std::string& word, Number least, std::vector<Problem>& problems) {
    if (word.empty()) return;
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc{} && end == word.data() + word.size() && value >= least && value <= static_cast<Number>(1000000)) number = value;
    else problems.push_back({option, 0, fmt::format("must be a number from {} to 1000000, not \"{}\"", least, word)});
}

AccuracyOptions checked(const AccuracyWords& words, std::vector<Problem>& problems) {
    AccuracyOptions options;
    options.run = checked_run_options(words.run, problems);
    if (!words.table.empty()) options.table = words.table;
    take(options.n_starts, "--starts", words.starts, 1, problems);
    take(options.collisions, "--collisions", words.collisions, 1e-3, problems);
    take(options.approach, "--approach", words.approach, 1e-3, problems);
    take(options.most_micro_steps, "--micro-steps", words.micro_steps, std::int64_t{1}, problems);
    take(options.threads, "--threads", words.threads, 1, problems);
    options.default_arithmetic_only = words.arithmetic == "default";
    if (words.arithmetic != "default" && words.arithmetic != "all")
        problems.push_back({"--arithmetic", 0, fmt::format("must be all or default, not \"{}\"", words.arithmetic)});
    if (const std::size_t slash = words.share.find('/'); slash != std::string::npos) {
        take(options.share, "--share", words.share.substr(0, slash), 1, problems);
        take(options.n_shares, "--share", words.share.substr(slash + 1), 1, problems);
    }
    if (!words.share.empty() && (words.share.find('/') == std::string::npos || options.share > options.n_shares))
        problems.push_back({"--share", 0, fmt::format("must be K/N with K from 1 to N, not \"{}\"", words.share)});
    return options;
}

} // namespace

void add_accuracy_command(CLI::App& app, Action& action) {
    auto words = std::make_shared<AccuracyWords>();
    CLI::App* command = app.add_subcommand("accuracy", "Measure what accuracy costs: a scene under many settings");
    command->set_help_flag("-h,--help", "Print this help and exit");
    command->add_option("INPUT", words->run.input, "SCENE.toml or FILE.in")->type_name("")->required();
    command->add_option("--output", words->table, "The table of CSV; default accuracy.csv")->type_name("FILE");
    command->add_option("--starts", words->starts, "Starts for each setting; default 8")->type_name("N");
    command->add_option("--collisions", words->collisions, "Collisions of a disc with others per trial; default 100")->type_name("C");
    command->add_option("--approach", words->approach, "And before it, to come to equilibrium; default 20")->type_name("C");
    command->add_option("--micro-steps", words->micro_steps, "Largest K of 1, 2, 4, ...; default 256")->type_name("K");
    command->add_option("--arithmetic", words->arithmetic, "all: both precisions and formulas; default: what runs use")
        ->type_name("all|default");
    command->add_option("--share", words->share, "The K-th of N shares of the trials only")->type_name("K/N");
    command->add_option("--threads", words->threads, "Threads; default 1")->type_name("T");
    command->add_option("--set", words->run.overrides, "Set any scene key; may be repeated")->type_name("KEY=VALUE")->allow_extra_args(false);
    command->add_flag("--quiet", words->run.quiet, "No progress");
    command->footer(teaching);
    command->callback([words, &action] {
        std::vector<Problem> problems;
        AccuracyOptions options = checked(*words, problems);
        action = [options = std::move(options), problems = std::move(problems)](const Communicator& ranks) {
            return study(options, problems, ranks);
        };
    });
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_command.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "apps/checkpoints.hpp"
#include "apps/disc_lines.hpp"
#include "apps/failure_scene.hpp"
#include "apps/hard_cases.hpp"
#include "apps/load.hpp"
#include "machine/machine.hpp"
#include "apps/progress.hpp"
#include "apps/recordings.hpp"
#include "apps/report_file.hpp"
#include "apps/run_options.hpp"
#include "apps/setting_choice.hpp"
#include "apps/standard_streams.hpp"
#include "apps/stop_signals.hpp"
#include "apps/stopwatch.hpp"
#include "apps/summary.hpp"
#include "parallel/agreement.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

namespace {

/// The largest of the ranks' times over their mean; 1 where there is none. **Collective.**
double imbalance_of(double seconds, const Communicator& ranks) {
    const auto nanoseconds = static_cast<std::uint64_t>(
        1e9 * seconds); // whole numbers: ranks add them in any order
    const auto sum = static_cast<double>(ranks.sum(nanoseconds));
    return sum > 0 ? static_cast<double>(ranks.max(nanoseconds)) * ranks.size() / sum : 1;
}

/// Times as they are on the slowest rank, and how even they are. **Collective.**
void fill_times(RunResult& result, const PhaseSeconds& mine, const Communicator& ranks) {
    ensure(ranks.min(std::uint64_t{mine.size()}) == mine.size(), "ranks have different phases");
    result.wall_seconds = ranks.max(result.wall_seconds);
    for (const auto& [name, seconds] : mine) {
        result.phase_seconds.emplace_back(name, ranks.max(seconds));
        result.phase_imbalance.emplace_back(name, imbalance_of(seconds, ranks));
    }
    result.imbalance = imbalance_of(busy_seconds(mine), ranks);
}

/// **Collective.**
void fill_machine(RunResult& result, const Communicator& ranks) {
    result.ranks = ranks.size();
    result.threads = static_cast<int>(ranks.max(std::int64_t{result.threads}));
    const std::uint64_t bytes = ranks.sum(peak_resident_bytes());
    result.peak_bytes_per_disc = static_cast<double>(bytes) /
                                 static_cast<double>(result.end.n_discs);
}

/// For what is measured of effects: a fiftieth of the run's time, and some moments of a short run.
CostsOfRun costs_of(const RunResult& result) {
    constexpr double least_budget = 0.05, largest_budget = 0.5; // seconds
    const std::uint64_t n_discs = result.end.n_discs - std::accumulate(result.end.departed.begin(),
                                                                       result.end.departed.end(),
                                                                       std::uint64_t{0});
    const double n_disc_steps = static_cast<double>(n_discs) *
                                static_cast<double>(result.last_step - result.first_step);
    const double processor_seconds = result.wall_seconds * result.ranks * result.threads;
    CostsOfRun costs;
    costs.n_discs = n_discs;
    costs.kinetic_energy = result.end.kinetic_energy;
    if (n_disc_steps > 0)
        costs.seconds_per_disc_step = std::max(processor_seconds / n_disc_steps, 1e-9);
    costs.budget = std::clamp(0.02 * result.wall_seconds, least_budget, largest_budget);
    return costs;
}

/// Summary and report, by rank 0. If the report cannot be written every rank throws.
/// **Collective.**
void print_result(const RunOptions& options, const Scene& scene, const RunResult& result,
                  const Communicator& ranks) {
    std::string failure;
    if (ranks.is_root()) {
        if (!options.quiet) print_message("{}", summary_text(scene, result));
        if (!options.report.empty())
            failure = write_whole_file(options.report, report_text(scene, result));
    }
    agree(ranks, failure.empty(), failure, ExitCode::output_failure);
}

/// Steps to the end of the scene, writing on the way what it asks for, or to where the run is told
/// to stop: false then. A restart does not write the lines of its first step again. **Collective.**
bool step_to_end(Simulation& simulation, RunResult& result, double& output_seconds,
                 const RunOptions& options, const Scene& scene, bool is_restart,
                 StoredSamples samples, const StopSignals& signals, const Communicator& ranks) {
    DiscLines lines(scene, options.output, options.digits, ranks);
    Progress progress(simulation.step(), scene.steps, ranks.is_root() && !options.quiet);
    Stopwatch watch;
    const auto write_if_due = [&] {
        if (!lines.is_due(simulation.step())) return;
        progress.finish(); // both may go to the same terminal
        lines.write(simulation);
    };
    if (!is_restart || simulation.step() == scene.steps) write_if_due();
    Checkpoints checkpoints(scene, simulation.step(), is_restart, signals, ranks, result.threads);
    Recordings recordings(scene, simulation, is_restart, std::move(samples), ranks);
    bool must_stop = checkpoints.look_up(simulation, recordings);
    output_seconds += watch.lap();
    while (simulation.step() < scene.steps && !must_stop) {
        const std::int64_t step = simulation.step();
        const std::int64_t next = std::min(
            {lines.next_due(step), checkpoints.next_look(step), recordings.next_due(step)});
        advance_or_report(simulation, next, scene, ranks);
        result.wall_seconds += watch.lap();
        write_if_due();
        recordings.record(simulation);
        must_stop = checkpoints.look_up(simulation, recordings);
        progress.show(simulation.step());
        output_seconds += watch.lap();
    }
    lines.close();
    recordings.finish();
    result.tables = recordings.tables();
    return !must_stop;
}

/// **Collective.**
void check_every_step(Simulation& simulation, const Scene& scene) {
    if (scene.precision != Precision::double_ || scene.arithmetic != Arithmetic::stable)
        throw InputError({{"--check", 0,
                           "its bounds are those of time.precision = \"double\" and "
                           "time.arithmetic = \"stable\"; leave one out"}});
    if (scene.effects.have_open_boundaries())
        throw InputError(
            {{"--check", 0,
              "it knows closed boxes only; leave sides of kind = \"open\" or --check out"}});
    simulation.check_every_step(scene);
}

/// The run itself. **Collective.**
ExitCode run(const RunOptions& options, const std::vector<Problem>& problems,
             const Communicator& ranks) {
    Stopwatch watch;
    std::optional<StopSignals> signals;
    if (options.input != "-")
        signals.emplace(ranks.is_root()); // else not while standard input may keep us waiting
    Loaded loaded = load(options, problems, ranks);
    if (!signals) signals.emplace(ranks.is_root());
    Tuning tuning = options.tuning;
    tuning.threads = options.threads.value_or(default_threads(ranks));
    if (const std::string warning = thread_warning();
        !warning.empty() && !options.threads && ranks.is_root())
        print_message("warning: {}: running with {} threads a rank\n", warning, tuning.threads);
    if (loaded.scene.accuracy)
        choose_setting(loaded.scene, loaded.discs, options.quiet, ranks, tuning);
    const Scene& scene = loaded.scene;
    const bool is_restart = loaded.stored.has_value();
    Simulation simulation = is_restart ? Simulation(scene, std::move(*loaded.stored), ranks, tuning)
                                       : Simulation(scene, std::move(loaded.discs), ranks, tuning);

    look_for_hard_cases(scene, simulation, ranks);
    if (options.check) check_every_step(simulation, scene);
    RunResult result;
    result.threads = tuning.threads;
    result.first_step = simulation.step();
    result.start = simulation.totals();
    if (ranks.is_root() && result.first_step == 0) warn_of_close_pairs(scene, result.start);
    const double setup_seconds = watch.lap();
    double output_seconds = 0;
    const bool is_done = step_to_end(simulation, result, output_seconds, options, scene, is_restart,
                                     std::move(loaded.samples), *signals, ranks);
    result.last_step = simulation.step();
    result.end = simulation.totals();
    result.averages = simulation.averages();
    result.runs = simulation.rollback_counts();

    PhaseSeconds phases = simulation.phase_seconds();
    phases.emplace_back("set-up", setup_seconds);
    phases.emplace_back("output", output_seconds);
    fill_times(result, phases, ranks);
    fill_machine(result, ranks);
    const bool is_reported = !options.quiet || !options.report.empty();
    if (scene.effects.are_any() && ranks.is_root() && is_reported && is_done)
        result.effect_costs = effect_costs(scene, costs_of(result));
    print_result(options, scene, result, ranks);
    if (!is_done && ranks.is_root())
        print_message(
            "stopped on request at step {} of {}; {}\n", result.last_step, scene.steps,
            scene.checkpoint
                ? fmt::format("run again with --restart {} to go on", scene.checkpoint->folder)
                : "nothing is kept to go on from: the scene has no output.checkpoint.folder");
    return is_done ? ExitCode::success : ExitCode::stopped;
}

/// Words of the command line that fit nowhere. After an unknown option the others may be its
/// values: left out then.
void add_leftovers(const std::vector<std::string>& words, std::vector<Problem>& problems) {
    bool has_unknown_option = false;
    for (const std::string& word : words) {
        if (word.size() < 2 || word.front() != '-') continue;
        problems.push_back({word, 0, "no such option; carrom run --help lists them"});
        has_unknown_option = true;
    }
    if (has_unknown_option) return;
    for (const std::string& word : words)
        problems.push_back({word, 0, "one input is enough; carrom run takes one at a time"});
}

} // namespace

void add_run_command(CLI::App& app, Action& action) {
    auto words = std::make_shared<RunWords>();
    CLI::App* command = app.add_subcommand("run", "Run a scene");
    declare_run_options(*command, *words);
    command->callback([words, command, &action] {
        std::vector<Problem> problems;
        add_leftovers(command->remaining(), problems);
        const bool input_is_certain = problems.empty();
        RunOptions options = checked_run_options(*words, problems);
        if (!input_is_certain) throw InputError(std::move(problems));
        action = [options = std::move(options), problems = std::move(problems)](
                     const Communicator& ranks) { return run(options, problems, ranks); };
    });
}

} // namespace carrom

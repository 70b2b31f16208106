// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_command/run_command.hpp"

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "apps/run_command/command_options.hpp"
#include "apps/run_command/disc_lines.hpp"
#include "apps/run_command/progress.hpp"
#include "apps/run_command/report.hpp"
#include "apps/run_command/summary.hpp"
#include "apps/shell/standard_streams.hpp"
#include "apps/shell/stop_signals.hpp"
#include "core/stop_request.hpp"
#include "core/stopwatch.hpp"
#include "engine/engine.hpp"
#include "engine/jammed.hpp"
#include "machine/machine.hpp"
#include "parallel/agreement.hpp"
#include "run/checkpoints.hpp"
#include "run/files/folder_guard.hpp"
#include "run/files/outputs.hpp"
#include "run/files/report_file.hpp"
#include "run/files/run_folder.hpp"
#include "run/hard_cases.hpp"
#include "run/recordings.hpp"
#include "run/run.hpp"
#include "run/start/load.hpp"
#include "run/start/restart.hpp"
#include "simulation/disc_system.hpp"
#include "simulation/known_bits.hpp"

namespace carrom {

namespace {

constexpr const char* run_footer = R"(Input:
  SCENE.toml   a scene; inputs/ has some, `carrom keys` lists the keys
  FILE.in      legacy text: N, L, r, S, print|perf, one per line, then nothing
               or N lines `id x y vx vy`
  -            legacy text on standard input (mpirun hands it to rank 0)

Standard output gets the lines `step id x y vx vy`, ids ascending, and nothing
else: steps 0 and S for `perf`, every step for `print`, what output.text says for
a scene. The lines of the last step end in ` p_c w_c`: collisions with discs, with walls.

Examples:
  carrom run inputs/gas.toml --threads 2
  mpirun -np 4 carrom run inputs/gas.toml --threads 2 --report report.json
  carrom run inputs/gas.toml --steps 100 --set output.text=every_step > gas.txt
  carrom run inputs/gas.toml -o FOLDER
  carrom run inputs/gas.toml -o FOLDER --resume
  carrom run --digits 8 - < input.in > output.txt

Exit codes: 0 done; 2 wrong input, nothing was done; 3 a rank failed; 4 output
could not be written; 70 a broken invariant; 75 stopped on request before the end.)";

/// Rank 0 prints the summary and writes the report. If the report cannot be written
/// every rank throws. **Collective.**
void print_result(const RunOptions& options, const SceneParameters& scene, const RunResult& result,
                  const Communicator& ranks) {
    std::string failure;
    if (ranks.is_root()) {
        if (!options.quiet) print_text(summary_text(scene, result));
        for (const std::string& warning : {warning_of_lost_collisions(scene, result),
                                           warning_of_guarded_collisions(scene, result)})
            if (!warning.empty()) print_message("warning: {}\n", warning);
        std::vector<std::string> reports;
        if (!options.report.empty()) reports.push_back(options.report);
        if (!scene.folder.empty()) reports.push_back(report_of_run(scene.folder));
        for (const std::string& path : reports)
            if (failure.empty()) failure = write_whole_file(path, report_text(scene, result));
    }
    agree(ranks, failure.empty(), failure, ExitCode::output_failure);
}

/// The error of a run that, on request, abandoned the step after `step`. `kept` describes the state
/// that is stored.
StopRequested given_up(std::int64_t step, const std::string& kept, const SceneParameters& scene) {
    return StopRequested(fmt::format(
        "stopped on request inside a step after {} of {}, which would take too long; {}{}", step,
        scene.steps, kept,
        scene.folder.empty() ? ""
                             : fmt::format("; carrom run -o {} --resume goes on", scene.folder)));
}

/// Writes the lines of discs to standard output or a file, and shows the progress.
class ShownSteps : public StepAction {
public:
    /// A restarted run does not write the lines of its first step again. **Collective.**
    ShownSteps(const Run& run, const RunOptions& options)
        : run_(run), lines_(run.scene(), options.output, options.digits, run.ranks()),
          progress_(run.step(), run.scene().steps, run.ranks().is_root() && !options.quiet),
          last_step_(run.step()) {
        if (!run.is_restart() || run.step() == run.last_step()) write_if_due();
    }

    std::int64_t next_due(std::int64_t step) const override { return lines_.next_due(step); }
    bool act() override {
        write_if_due();
        last_step_ = run_.step();
        progress_.show(last_step_);
        return true;
    }
    /// The last step that has been completed.
    std::int64_t last_step() const { return last_step_; }
    /// Ends the progress line, and closes the output of discs. **Collective.**
    void finish() {
        progress_.finish();
        lines_.close();
    }

private:
    void write_if_due() {
        lines_.end_at(run_.last_step());
        if (!lines_.is_due(run_.step())) return;
        progress_.finish(); // progress and lines may go to the same terminal
        lines_.write(run_.system());
    }

    const Run& run_;
    DiscLines lines_;
    Progress progress_;
    std::int64_t last_step_;
};

/// Runs to the end of the scene with all outputs. Returns false if the run was stopped on request
/// before its end. **Collective.**
bool step_to_end(Run& run, const RunOptions& options, FolderGuard& guard, double& output_seconds) {
    const SceneParameters& scene = run.scene();
    Stopwatch watch;
    Recordings recordings(run, options.messages);
    Checkpoints checkpoints(run, scene.checkpoint);
    // Older outputs are replaced and removed only from here on, after all input has been checked.
    prepare_outputs(scene, !run.is_restart(), run.ranks());
    ShownSteps shown(run, options);
    recordings.begin();
    for (StepAction* action :
         std::initializer_list<StepAction*>{&guard, &shown, &recordings, &checkpoints})
        run.add(*action);
    bool is_done = checkpoints.act() || run.step() >= run.last_step();
    output_seconds += watch.lap();
    try {
        is_done = is_done && run.advance_to(scene.steps);
    } catch (const StopRequested&) {
        shown.finish();
        throw given_up(shown.last_step(), checkpoints.write_copy(), scene);
    } catch (const Jammed& jam) {
        shown.finish();
        const std::int64_t safe = jam.safe_micro_step() / scene.micro_steps;
        throw CollectiveError(fmt::format("{}; {}; try: {}", jam.what(), checkpoints.keep(safe),
                                          safe > 0 ? fmt::format("--steps {}", safe)
                                                   : "a smaller effects.growth.rate"),
                              jam.code());
    }
    watch.lap();
    shown.finish();
    recordings.finish();
    output_seconds += watch.lap() + run.seconds().actions;
    return is_done;
}

/// Makes the run check its invariants at each step. **Collective.**
void check_every_step(DiscSystem& system, const SceneParameters& scene) {
    if (scene.precision != Precision::double_ || scene.arithmetic != Arithmetic::stable)
        throw InputError({{"--check", 0,
                           "its bounds are those of time.precision = \"double\" and "
                           "time.arithmetic = \"stable\"; leave one out"}});
    if (scene.gpu)
        throw InputError({{"--check", 0,
                           "it follows single collisions, which a GPU does not list; leave "
                           "machine.gpu or --check out"}});
    system.check_every_step(scene);
}

void warn_of_threads(int threads, bool are_chosen, const Communicator& ranks) {
    const std::string unheeded = are_chosen ? "" : warning_of_thread_variable();
    if (ranks.is_root() && !unheeded.empty())
        print_message("warning: {}: running with {} threads a rank\n", unheeded, threads);
}

/// Warns if results on this machine differ in their bits from those on other machines.
/// **Collective.**
void warn_of_other_bits(const Communicator& ranks) {
    const std::string difference = warning_of_other_bits(ranks);
    if (ranks.is_root() && !difference.empty()) print_message("warning: {}\n", difference);
}

} // namespace

ExitCode run_scene(RunOptions options, const std::vector<Problem>& problems,
                   const Communicator& ranks) {
    options.messages = messages_of(ranks, options.quiet);
    Stopwatch watch;
    std::optional<StopSignals> signals;
    if (options.input != "-")
        signals.emplace(ranks.is_root()); // reading standard input may take long, and meanwhile a
                                          // signal must end the program
    Loaded loaded = load(options, problems, ranks);
    if (!signals) signals.emplace(ranks.is_root());
    Tuning tuning = options.tuning;
    tuning.threads = options.threads.value_or(default_threads(ranks));
    warn_of_threads(tuning.threads, options.threads.has_value(), ranks);
    warn_of_other_bits(ranks);
    Run run(std::move(loaded.scene), std::move(loaded.start), ranks, tuning, options.messages);
    const SceneParameters& scene = run.scene();
    const std::string small = warning_of_small_domains(scene, ranks.size(), tuning.threads);
    if (!small.empty()) options.messages.warn("{}: warning: {}\n", scene.name, small);
    DiscSystem& system = run.system();
    if (options.check) check_every_step(system, scene);
    RunResult result;
    result.threads = tuning.threads;
    result.first_step = system.step();
    result.start = system.totals();
    if (result.first_step == 0) warn_of_close_pairs(scene, result.start, options.messages);
    const double setup_seconds = watch.lap();
    double output_seconds = 0;
    bool is_done = false;
    FolderGuard guard(loaded.locks, scene, ranks);
    try {
        is_done = step_to_end(run, options, guard, output_seconds);
    } catch (const CollectiveError& error) {
        // If the run's folder has been moved or removed, `commit` throws an error that says so
        if (error.code() == ExitCode::output_failure) guard.commit();
        throw;
    }
    result.wall_seconds = run.seconds().steps;
    fill_end(result, run);
    PhaseSeconds phases = system.engine().phase_seconds();
    phases.emplace_back("set-up", setup_seconds);
    phases.emplace_back("output", output_seconds);
    fill_times(result, phases, ranks);
    print_result(options, scene, result, ranks);
    if (!is_done && ranks.is_root())
        print_message("stopped on request at step {} of {}; {}\n", result.last_step, scene.steps,
                      scene.folder.empty()
                          ? "nothing is kept to go on from: the run has no output.folder"
                          : fmt::format("carrom run -o {} --resume goes on", scene.folder));
    return is_done ? ExitCode::success : ExitCode::stopped;
}

Subcommand run_subcommand() {
    const auto given = std::make_shared<RunOptions>();
    const auto action = [given](std::vector<Problem>& problems) -> Action {
        RunOptions options = completed(*given, problems);
        const bool has_input = !options.input.empty() || goes_on(options);
        if (!has_input)
            problems.push_back({"carrom run", 0,
                                "no input; name a SCENE.toml, a FILE.in, or - for standard input"});
        // While a run waits for standard input, a signal must end it
        const bool reads_input = options.input == "-";
        if (!has_input) return failing(problems);
        return {[options = std::move(options), problems](const Communicator& ranks) {
                    return run_scene(options, problems, ranks);
                },
                true, !reads_input};
    };
    return {"run",      "Run a scene",
            run_footer, run_options(*given),
            action,     "one input is enough; carrom run takes one at a time"};
}

} // namespace carrom

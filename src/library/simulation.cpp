// SPDX-License-Identifier: BSD-3-Clause
#include <carrom/simulation.hpp>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "io/files.hpp"
#include "library/checked_source.hpp"
#include "library/live_part.hpp"
#include "library/session_state.hpp"
#include "library/simulation_state.hpp"
#include "machine/machine.hpp"
#include "parallel/agreement.hpp"
#include "parallel/meeting.hpp"
#include "parallel/sample_sort.hpp"
#include "run/start/restart.hpp"

namespace carrom {

namespace {

/// Steps between updates of image counts. An update empties the list of crossings of periodic
/// sides, to which each sync adds at most one for each disc. By default syncs are 64 micro-steps
/// apart.
constexpr std::int64_t steps_between_readings = 64;

/// Images can be counted only for periodic sides at rest.
bool may_count_images(const Options& options, const SceneParameters& scene) {
    return options.counts_images && !scene.effects.are_sheared() &&
           (scene.effects.is_periodic_x() || scene.effects.is_periodic_y());
}

/// **Collective.**
Tuning tuning_of(const Options& options, const Communicator& ranks) {
    std::vector<Problem> problems; // problems of this rank; other ranks may have none
    if (options.threads < 0)
        problems.push_back({"Options", 0, fmt::format("{} threads", options.threads)});
    agree_on_problems(ranks, problems);
    Tuning tuning;
    const int usual = default_threads(ranks);
    tuning.threads = options.threads > 0 ? options.threads : usual;
    check_threads(tuning.threads, ranks);
    return tuning;
}

Messages messages_of(const Options& options, const Communicator& ranks) {
    return ranks.is_root() ? Messages(options.messages) : Messages();
}

std::unique_ptr<Simulation::State> begun(const Session& session, const Scene& scene,
                                         const Options& options) {
    const Communicator& ranks = ranks_of(session);
    meet(ranks, "Simulation");
    const Tuning tuning = tuning_of(options, ranks);
    FirstState first = first_state(scene, ranks, tuning);
    RunStart start{.discs = std::move(first.discs)};
    start.counts_images = may_count_images(options, first.scene);
    return std::make_unique<Simulation::State>(std::move(first.scene), std::move(start), ranks,
                                               tuning, messages_of(options, ranks));
}

bool is_earlier(const Disc& a, const Disc& b) { return a.id < b.id; }

} // namespace

Simulation::State::State(SceneParameters checked, RunStart start, const Communicator& ranks,
                         const Tuning& of_run, const Messages& messages)
    : tuning(of_run),
      run_(std::make_unique<Run>(std::move(checked), std::move(start), ranks, tuning, messages)) {
    facts = facts_of(run_->scene());
    read_images_often();
}

std::int64_t Simulation::State::ImageReading::next_due(std::int64_t) const {
    // Never due by itself, because the run calls all its actions often enough
    return std::numeric_limits<std::int64_t>::max();
}

bool Simulation::State::ImageReading::act() {
    if (run.step() - last_step < steps_between_readings) return true;
    static_cast<void>(run.images()->counts());
    last_step = run.step();
    return true;
}

void Simulation::State::read_images_often() {
    image_reading_.reset();
    if (run_->images()) run_->add(image_reading_.emplace(*run_));
}

void Simulation::State::replace(RunStart start, std::optional<std::uint64_t> most_overlaps) {
    auto next = std::make_unique<Run>(scene_to_go_on(*run_), std::move(start), run_->ranks(),
                                      tuning);
    if (most_overlaps) {
        const Totals totals = next->system().totals();
        if (totals.overlapping_pairs > *most_overlaps)
            throw InputError({{"change_discs", 0,
                               fmt::format("{} pairs of discs would overlap, the deepest by {:.3g}",
                                           totals.overlapping_pairs, totals.deepest_overlap)}});
    }
    checkpoints_.reset(); // this object refers to the old run
    run_ = std::move(next);
    read_images_often();
    if (wanted_checkpoints_) keep_checkpoints(*wanted_checkpoints_);
}

void Simulation::State::keep_checkpoints(CheckpointOutput wanted) {
    wanted_checkpoints_ = wanted;
    checkpoints_.emplace(*run_, std::move(wanted));
    run_->add(*checkpoints_);
}

Simulation::Simulation(const Session& session, const Scene& scene, const Options& options)
    : state_(begun(session, scene, options)) {}

Simulation::Simulation(std::unique_ptr<State> state) : state_(std::move(state)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation::State& Simulation::live() const { return live_part(state_, "Simulation"); }

Simulation Simulation::from_checkpoint(const Session& session, const std::string& path,
                                       const std::vector<std::string>& settings,
                                       const Options& options) {
    const Communicator& ranks = ranks_of(session);
    std::string all = path;
    for (const std::string& setting : settings) all += '\n' + setting;
    meet(ranks, "Simulation::from_checkpoint", hash_of_argument(all));
    RunOptions wanted;
    wanted.restart = path;
    wanted.overrides = settings;
    wanted.messages = messages_of(options, ranks);
    SceneParameters scene;
    RunStart start;
    with_named_keys([&] {
        start = read_restart(plan_restart(wanted, scene, ranks), wanted, scene, ranks).value();
    });
    start.counts_images = may_count_images(options, scene);
    return Simulation(std::make_unique<State>(std::move(scene), std::move(start), ranks,
                                              tuning_of(options, ranks), wanted.messages));
}

const SceneFacts& Simulation::scene() const { return live().facts; }
std::int64_t Simulation::step() const { return live().run().step(); }
Box Simulation::box() const { return live().run().system().engine().box(); }

void Simulation::advance(std::int64_t n_steps) {
    const std::int64_t left = live().facts.steps - step();
    advance_to(n_steps > left ? live().facts.steps + 1 : step() + n_steps);
}

void Simulation::advance_to(std::int64_t step) {
    meet(live().run().ranks(), "Simulation::advance_to", static_cast<std::uint64_t>(step));
    if (step < this->step() || step > live().facts.steps)
        throw InputError({{"advance_to", 0,
                           fmt::format("step {} is not from the present step {} to time.steps = {}",
                                       step, this->step(), live().facts.steps)}});
    live().run().advance_to(step);
}

std::vector<Disc> Simulation::discs() const {
    const DiscSystem& system = live().run().system();
    const double unit = system.velocity_unit(), clock = system.clock();
    const Origin& origin = live().run().scene().origin;
    const std::span<const double> spins = system.spins();
    std::vector<Disc> discs;
    discs.reserve(system.discs().size());
    for (const DiscState& shown : system.shown()) {
        Disc& disc = discs.emplace_back();
        disc.id = shown.id;
        disc.x = shown.x_at(clock) - origin.x;
        disc.y = shown.y_at(clock) - origin.y;
        disc.vx = shown.vx * unit;
        disc.vy = shown.vy * unit;
        disc.wall_collisions = shown.wall_collisions;
        disc.pair_collisions = shown.pair_collisions;
        if (!spins.empty()) disc.spin = spins[discs.size() - 1] * unit;
    }
    std::sort(discs.begin(), discs.end(), is_earlier);
    return discs;
}

std::vector<Disc> Simulation::gathered_discs() const {
    meet(live().run().ranks(), "Simulation::gathered_discs");
    return sample_sort(live().run().ranks(), discs(), is_earlier, 1);
}

Totals Simulation::totals() const {
    meet(live().run().ranks(), "Simulation::totals");
    return live().run().system().totals();
}
Averages Simulation::averages() const {
    meet(live().run().ranks(), "Simulation::averages");
    return live().run().sampler().averages();
}
void Simulation::restart_averages() {
    meet(live().run().ranks(), "Simulation::restart_averages");
    live().run().sampler().average_anew();
}

std::vector<MeasuredTable> Simulation::measurements() const {
    return live().run().sampler().tables();
}

void Simulation::write_checkpoint(const std::string& path) const {
    meet(live().run().ranks(), "Simulation::write_checkpoint", hash_of_argument(path));
    live().run().write_checkpoint(path);
}

void Simulation::keep_checkpoints(const CheckpointSchedule& schedule) {
    meet(live().run().ranks(), "Simulation::keep_checkpoints", hash_of_argument(schedule.folder));
    const Communicator& ranks = live().run().ranks();
    std::vector<Problem> problems;
    const auto refuse = [&problems](const char* key, const auto& number, const char* accepted) {
        problems.push_back(
            {"keep_checkpoints", 0, fmt::format("{} = {}; {}", key, number, accepted)});
    };
    if (live().keeps_checkpoints())
        problems.push_back({"keep_checkpoints", 0, "has been called before"});
    if (schedule.folder.find('\0') != std::string::npos)
        problems.push_back({"keep_checkpoints", 0, "no folder has a NUL in its name"});
    if (schedule.folder.empty()) problems.push_back({"keep_checkpoints", 0, "names no folder"});
    if (schedule.every_steps < 0) refuse("every_steps", schedule.every_steps, "0 or more steps");
    if (!(schedule.every_minutes >= 0))
        refuse("every_minutes", schedule.every_minutes, "0 or more minutes");
    if (schedule.keep < 1) refuse("keep", schedule.keep, "1 or more checkpoints");
    if (!problems.empty()) throw InputError(std::move(problems));
    on_root(ranks, schedule.folder, ExitCode::output_failure, [&] {
        std::error_code error;
        std::filesystem::create_directories(schedule.folder, error);
        if (error) throw FileError("cannot be made: " + error.message());
    });
    CheckpointOutput wanted;
    wanted.folder = schedule.folder;
    wanted.keep = schedule.keep;
    wanted.at_end = schedule.at_end;
    if (schedule.every_steps > 0) wanted.every_steps = schedule.every_steps;
    if (schedule.every_minutes > 0) wanted.every_minutes = schedule.every_minutes;
    live().keep_checkpoints(std::move(wanted));
}

} // namespace carrom

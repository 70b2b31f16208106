// SPDX-License-Identifier: BSD-3-Clause
#include <carrom/simulation.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/checkpoint.hpp"
#include "library/checked_source.hpp"
#include "library/live_part.hpp"
#include "library/session_state.hpp"
#include "library/simulation_state.hpp"
#include "machine/machine.hpp"
#include "parallel/agreement.hpp"
#include "parallel/meeting.hpp"
#include "parallel/sample_sort.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom::api {

namespace {

/// **Collective.**
Tuning tuning_of(const Options& options, const Communicator& ranks) {
    std::vector<Problem> problems; // of one rank alone, perhaps
    if (options.threads < 0)
        problems.push_back({"Options", 0, fmt::format("{} threads", options.threads)});
    agree_on_problems(ranks, problems);
    Tuning tuning;
    const int usual = default_threads(ranks);
    tuning.threads = options.threads > 0 ? options.threads : usual;
    check_threads(tuning.threads, ranks);
    return tuning;
}

std::unique_ptr<Simulation::State> begun(const Session& session, const Scene& scene,
                                         const Options& options) {
    const Communicator& ranks = ranks_of(session);
    meet(ranks, "Simulation");
    const Tuning tuning = tuning_of(options, ranks);
    FirstState first = first_state(scene, ranks, tuning);
    return std::make_unique<Simulation::State>(ranks, std::move(first.scene),
                                               std::move(first.discs), tuning);
}

bool is_earlier(const Disc& a, const Disc& b) { return a.id < b.id; }

} // namespace

Simulation::State::State(const Communicator& all, carrom::Scene checked,
                         std::vector<InputDisc> discs, const Tuning& tuning)
    : ranks(all), scene(std::move(checked)), facts(facts_of(scene)), n_threads(tuning.threads),
      simulation(scene, std::move(discs), ranks, tuning) {
    if (!scene.measurements) return;
    sampler.emplace(scene, simulation, ranks);
    sampler->look();
}

Simulation::State::State(const Communicator& all, carrom::Scene checked, StoredState stored,
                         StoredSamples samples, const Tuning& tuning)
    : ranks(all), scene(std::move(checked)), facts(facts_of(scene)), n_threads(tuning.threads),
      simulation(scene, std::move(stored), ranks, tuning) {
    simulation.go_on_averaging(samples.averages);
    if (!scene.measurements) return;
    sampler.emplace(scene, simulation, ranks);
    sampler->go_on(std::move(samples));
    sampler->look();
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
    Checkpoint checkpoint = read_checkpoint(path, ranks);
    const CheckpointHeader& header = checkpoint.header;
    carrom::Scene scene = with_named_keys([&] { return scene_of(header, settings); });
    refuse_other_run(header, scene, path);
    if (scene.steps < header.step)
        throw InputError({{path, 0,
                           fmt::format("the checkpoint is of step {}, and time.steps is {}",
                                       header.step, scene.steps)}});
    StoredState stored{std::move(checkpoint.discs), header.micro_steps_done,
                       std::move(checkpoint.columns)};
    return Simulation(std::make_unique<State>(ranks, std::move(scene), std::move(stored),
                                              std::move(checkpoint.samples),
                                              tuning_of(options, ranks)));
}

const SceneFacts& Simulation::scene() const { return live().facts; }
std::int64_t Simulation::step() const { return live().simulation.step(); }

void Simulation::advance(std::int64_t n_steps) {
    const std::int64_t left = live().scene.steps - step();
    advance_to(n_steps > left ? live().scene.steps + 1 : step() + n_steps);
}

void Simulation::advance_to(std::int64_t step) {
    meet(live().ranks, "Simulation::advance_to", static_cast<std::uint64_t>(step));
    carrom::Simulation& simulation = live().simulation;
    if (step < simulation.step() || step > live().scene.steps)
        throw InputError({{"advance_to", 0,
                           fmt::format("step {} is not from the present step {} to time.steps = {}",
                                       step, simulation.step(), live().scene.steps)}});
    while (simulation.step() < step) {
        std::int64_t next = step;
        if (live().sampler) next = std::min(next, live().sampler->next_due(simulation.step()));
        simulation.advance_towards(next);
        if (live().sampler) live().sampler->look();
    }
}

std::vector<Disc> Simulation::discs() const {
    const carrom::Simulation& simulation = live().simulation;
    const double unit = simulation.velocity_unit(), clock = simulation.clock();
    const std::span<const double> spins = simulation.spins();
    std::vector<Disc> discs;
    discs.reserve(simulation.discs().size());
    for (const carrom::Disc& shown : simulation.shown()) {
        Disc& disc = discs.emplace_back();
        disc.id = shown.id;
        disc.x = shown.x_at(clock);
        disc.y = shown.y_at(clock);
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
    meet(live().ranks, "Simulation::gathered_discs");
    return sample_sort(live().ranks, discs(), is_earlier, 1);
}

Totals Simulation::totals() const {
    meet(live().ranks, "Simulation::totals");
    return live().simulation.totals();
}
Averages Simulation::averages() const {
    meet(live().ranks, "Simulation::averages");
    return live().simulation.averages();
}
void Simulation::restart_averages() {
    meet(live().ranks, "Simulation::restart_averages");
    live().simulation.average_anew();
}

std::vector<MeasuredTable> Simulation::measurements() const {
    return live().sampler ? live().sampler->tables() : std::vector<MeasuredTable>{};
}

void Simulation::write_checkpoint(const std::string& path) const {
    const State& now = live();
    meet(now.ranks, "Simulation::write_checkpoint", hash_of_argument(path));
    StoredSamples samples = now.sampler ? now.sampler->stored() : StoredSamples{};
    samples.averages = now.simulation.stored_averages();
    carrom::write_checkpoint(path, header_now(now.scene, now.simulation), now.simulation.discs(),
                             now.ranks, {.n_threads = now.n_threads}, samples,
                             now.simulation.side_columns());
}

} // namespace carrom::api

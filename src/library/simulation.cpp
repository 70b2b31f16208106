// SPDX-License-Identifier: BSD-3-Clause
#include <carrom/simulation.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/checkpoint.hpp"
#include "library/checked_source.hpp"
#include "library/session_state.hpp"
#include "library/simulation_state.hpp"
#include "machine/machine.hpp"
#include "parallel/sample_sort.hpp"
#include "stored_scene/stored_scene.hpp"

namespace carrom::api {

namespace {

/// **Collective.**
Tuning tuning_of(const Options& options, const Communicator& ranks) {
    if (options.threads < 0)
        throw InputError({{"Options", 0, fmt::format("{} threads", options.threads)}});
    Tuning tuning;
    const int usual = default_threads(ranks);
    tuning.threads = options.threads > 0 ? options.threads : usual;
    check_threads(tuning.threads, ranks);
    return tuning;
}

std::unique_ptr<Simulation::State> begun(const Session& session, const Scene& scene,
                                         const Options& options) {
    const Communicator& ranks = ranks_of(session);
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
    sampler->go_on(samples);
    sampler->look();
}

Simulation::Simulation(const Session& session, const Scene& scene, const Options& options)
    : state_(begun(session, scene, options)) {}

Simulation::Simulation(std::unique_ptr<State> state) : state_(std::move(state)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Simulation Simulation::from_checkpoint(const Session& session, const std::string& path,
                                       const std::vector<std::string>& settings,
                                       const Options& options) {
    const Communicator& ranks = ranks_of(session);
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

const SceneFacts& Simulation::scene() const { return state_->facts; }
std::int64_t Simulation::step() const { return state_->simulation.step(); }

void Simulation::advance(std::int64_t n_steps) {
    const std::int64_t left = state_->scene.steps - step();
    advance_to(n_steps > left ? state_->scene.steps + 1 : step() + n_steps);
}

void Simulation::advance_to(std::int64_t step) {
    carrom::Simulation& simulation = state_->simulation;
    if (step < simulation.step() || step > state_->scene.steps)
        throw InputError({{"advance_to", 0,
                           fmt::format("step {} is not from the present step {} to time.steps = {}",
                                       step, simulation.step(), state_->scene.steps)}});
    while (simulation.step() < step) {
        std::int64_t next = step;
        if (state_->sampler) next = std::min(next, state_->sampler->next_due(simulation.step()));
        simulation.advance_towards(next);
        if (state_->sampler) state_->sampler->look();
    }
}

std::vector<Disc> Simulation::discs() const {
    const carrom::Simulation& simulation = state_->simulation;
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
    return sample_sort(state_->ranks, discs(), is_earlier, 1);
}

Totals Simulation::totals() const { return state_->simulation.totals(); }
Averages Simulation::averages() const { return state_->simulation.averages(); }
void Simulation::restart_averages() { state_->simulation.average_anew(); }

std::vector<MeasuredTable> Simulation::measurements() const {
    return state_->sampler ? state_->sampler->tables() : std::vector<MeasuredTable>{};
}

void Simulation::write_checkpoint(const std::string& path) const {
    const State& now = *state_;
    StoredSamples samples = now.sampler ? now.sampler->stored() : StoredSamples{};
    samples.averages = now.simulation.stored_averages();
    carrom::write_checkpoint(path, header_now(now.scene, now.simulation), now.simulation.discs(),
                             now.ranks, {.n_threads = now.n_threads}, samples,
                             now.simulation.side_columns());
}

} // namespace carrom::api

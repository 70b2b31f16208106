// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/state_check.hpp"
#include "engine/engine.hpp"
#include "engine/state_sums.hpp"
#include "event_driven/event_driven_engine.hpp"
#include "statistics/block_averages.hpp"
#include "statistics/pair_distances.hpp"
#include "time_stepped/time_stepped_engine.hpp"

namespace carrom {

namespace {

/// Lists of no more than this are given back to the system one by one.
constexpr std::size_t discs_in_part = 1 << 16;

/// The same in many lists. What was one no longer exists then, though a parameter may live as long
/// as the expression that the call is in.
std::vector<std::vector<InputDisc>> in_parts(std::vector<InputDisc> discs) {
    std::vector<std::vector<InputDisc>> parts;
    parts.reserve(discs.size() / discs_in_part + 1); // below them on the heap
    for (auto begin = discs.begin(); begin != discs.end();
         begin += static_cast<std::ptrdiff_t>(parts.back().size()))
        parts.emplace_back(begin,
                           begin + std::min<std::ptrdiff_t>(discs_in_part, discs.end() - begin));
    std::vector<InputDisc>().swap(discs);
    return parts;
}

/// Uses the inputs up: they go as states come, for together they would be the most that a run
/// keeps.
StoredState first_state(const Scene& scene, std::vector<InputDisc> inputs) {
    const auto k = static_cast<double>(scene.micro_steps);
    StoredState state;
    const std::size_t n = inputs.size();
    std::vector<std::vector<InputDisc>> parts = in_parts(std::move(inputs));
    state.discs.reserve(n);
    for (; !parts.empty(); parts.pop_back()) { // from the end: there the heap shrinks
        for (const InputDisc& input : parts.back()) {
            Disc& disc = state.discs.emplace_back();
            disc.id = input.id;
            disc.x = input.x;
            disc.y = input.y;
            disc.vx = input.vx / k;
            disc.vy = input.vy / k;
            if (!scene.spins.empty()) state.spins.push_back(first_spin(scene, input.id) / k);
        }
    }
    return state;
}

std::unique_ptr<Engine> engine_for(const Scene& scene, StoredState state,
                                   const Communicator& communicator, const Tuning& tuning) {
    if (scene.method == Method::event_driven)
        return make_event_driven_engine(scene, std::move(state), communicator, tuning);
    return make_time_stepped_engine(scene, std::move(state), communicator, tuning);
}

} // namespace

Simulation::Simulation(const Scene& scene, std::vector<InputDisc> discs,
                       const Communicator& communicator, const Tuning& tuning)
    : Simulation(scene, first_state(scene, std::move(discs)), communicator, tuning) {}

Simulation::Simulation(const Scene& scene, StoredState state, const Communicator& communicator,
                       const Tuning& tuning)
    : communicator_(communicator), velocity_unit_(static_cast<double>(scene.micro_steps)),
      effects_(scene.effects), box_size_(scene.box_size), n_threads_(tuning.threads),
      engine_(engine_for(scene, std::move(state), communicator, tuning)),
      averages_(std::make_unique<BlockAverages>(
          AveragedSystem{static_cast<double>(engine_->n_discs()), scene.box_size, scene.radius,
                         velocity_unit_, scene.micro_steps, scene.sync_every,
                         !scene.effects.are_any(), !scene.effects.have_open_boundaries()})) {}

Simulation::~Simulation() = default;

void Simulation::advance_towards(std::int64_t last_step) {
    if (!averages_->has_begun()) average_anew();
    if (check_ && step() < last_step)
        advance_checked();
    else
        engine_->advance_towards(
            last_step); // never beyond the first step after a sync, where blocks may end
    if (averages_->ends_block(step()))
        averages_->end_block(step(),
                             look_at(in_motion(), engine_->n_discs(), n_threads_, communicator_));
}

void Simulation::check_every_step(const Scene& scene) {
    check_ = std::make_unique<StateCheck>(scene, discs(), micro_steps_done(), communicator_,
                                          frame(), clock(), spins());
}

void Simulation::advance_checked() {
    std::vector<Collision> collisions;
    engine_->log_to(&collisions);
    engine_->advance_towards(step() + 1);
    engine_->log_to(log_);
    const LocalView now = engine_->local_view();
    check_->look(now, micro_steps_done(), collisions, engine_->spins());
    engine_->forget_images();
    if (log_) log_->insert(log_->end(), collisions.begin(), collisions.end());
}

void Simulation::average_anew() {
    averages_->begin(step(), look_at(in_motion(), engine_->n_discs(), n_threads_, communicator_));
}

Averages Simulation::averages() const {
    if (!averages_->has_begun()) return {};
    return averages_->averages(step(),
                               look_at(in_motion(), engine_->n_discs(), n_threads_, communicator_));
}

std::int64_t Simulation::step() const {
    return micro_steps_done() / static_cast<std::int64_t>(velocity_unit_);
}

std::int64_t Simulation::micro_steps_done() const { return engine_->micro_steps_done(); }

std::span<const Disc> Simulation::discs() const {
    if (engine_->departed().empty()) return engine_->own();
    stored_.assign(engine_->own().begin(), engine_->own().end());
    stored_.insert(stored_.end(), engine_->departed().begin(), engine_->departed().end());
    return stored_;
}

std::span<const double> Simulation::spins() const {
    if (engine_->departed().empty() || effects_.contact.kind != ContactKind::rough)
        return engine_->spins();
    stored_spins_.assign(engine_->spins().begin(), engine_->spins().end());
    stored_spins_.resize(engine_->spins().size() + engine_->departed().size(), 0);
    return stored_spins_;
}

Frame Simulation::frame() const { return engine_->frame(); }

std::span<const Disc> Simulation::shown() const {
    const Frame now = frame();
    if (!now.is_moving) return discs();
    shown_.clear();
    for (const Disc& disc : discs()) shown_.push_back(now.in_box(disc, clock()));
    return shown_;
}

std::span<const Disc> Simulation::in_motion() const {
    return frame().keeps_velocities() ? discs() : shown();
}

double Simulation::clock() const { return engine_->clock(); }

void Simulation::log_to(std::vector<Collision>* log) {
    log_ = log;
    engine_->log_to(log);
}

void Simulation::add_impulses_to(WallImpulses* impulses) { engine_->add_impulses_to(impulses); }

void Simulation::note_crossings_in(std::vector<Crossing>* crossings) {
    engine_->note_crossings_in(crossings);
}

void Simulation::count_pair_distances(double bin_width, std::span<const DiscId> species_ends,
                                      std::span<std::uint64_t> counts) const {
    const LocalView now = engine_->local_view(
        bin_width * static_cast<double>(counts.size() / n_pair_kinds(species_ends.size())));
    carrom::count_pair_distances(now, bin_width, species_ends, n_threads_, counts);
    engine_->forget_images();
}

Totals Simulation::totals() const {
    Totals totals;
    totals.n_discs = engine_->n_discs();
    measure_collisions(discs(), spins(), communicator_, totals);
    measure_departures(discs(), box_size_, communicator_, totals);
    const SpeciesTable* const species_table = effects_.species.empty() ? nullptr
                                                                       : engine_->species_table();
    measure_motion(in_motion(), species_table, velocity_unit_, communicator_, totals);
    if (effects_.contact.kind == ContactKind::rough)
        measure_rotation(discs(), spins(), *engine_->species_table(), effects_.contact.inertia,
                         velocity_unit_, communicator_, totals);
    if (effects_.gravity.is_any())
        measure_height(shown(), species_table, effects_.gravity, box_size_, communicator_, totals);
    engine_->add_to(totals);
    return totals;
}

RollbackCounts Simulation::rollback_counts() const { return engine_->rollback_counts(); }

PhaseSeconds Simulation::phase_seconds() const { return engine_->phase_seconds(); }

} // namespace carrom

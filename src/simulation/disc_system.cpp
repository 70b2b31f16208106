// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/disc_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/state_check.hpp"
#include "dynamics/species.hpp"
#include "engine/engine.hpp"
#include "engine/state_sums.hpp"
#include "event_driven/event_driven_engine.hpp"
#include "gpu/gpu.hpp"
#include "scene/effects/effect.hpp"
#include "statistics/motion.hpp"
#include "time_stepped/time_stepped_engine.hpp"

namespace carrom {

namespace {

/// Largest number of discs in a part of the input; a part's memory can only be freed as a whole.
constexpr std::size_t discs_in_part = 1 << 16;
/// Number of halo discs for which memory is reserved, divided by the square root of the number of
/// own discs: 32 layers of discs at each of four sides. Without this reserve all discs would be
/// copied when the halo grows.
constexpr double halo_per_root = 128;

/// Moves the discs into many lists and frees the original list. A caller's argument might otherwise
/// keep it in memory until the end of the expression.
std::vector<std::vector<InputDisc>> in_parts(std::vector<InputDisc> discs) {
    std::vector<std::vector<InputDisc>> parts;
    // Allocated first, so that this list lies below the parts in memory
    parts.reserve(discs.size() / discs_in_part + 1);
    for (auto begin = discs.begin(); begin != discs.end();
         begin += static_cast<std::ptrdiff_t>(parts.back().size()))
        parts.emplace_back(begin,
                           begin + std::min<std::ptrdiff_t>(discs_in_part, discs.end() - begin));
    std::vector<InputDisc>().swap(discs);
    return parts;
}

/// Makes the state at step 0, and frees the inputs meanwhile. Otherwise the two together would need
/// the most memory of the whole run.
StoredState first_state(const SceneParameters& scene, std::vector<InputDisc> inputs) {
    const auto k = static_cast<double>(scene.micro_steps);
    const double rate_unit = scene.velocities == VelocityKind::reversed ? -k : k;
    StoredState state;
    BySideColumn<std::vector<double>> numbers;
    const std::size_t n = inputs.size();
    std::vector<std::vector<InputDisc>> parts = in_parts(std::move(inputs));
    state.discs.reserve(
        n + static_cast<std::size_t>(halo_per_root * std::sqrt(static_cast<double>(n))));
    // Begins with the last inputs, so that the heap can shrink when they are freed
    for (; !parts.empty(); parts.pop_back()) {
        for (const InputDisc& input : parts.back()) {
            DiscState& disc = state.discs.emplace_back(DiscState{});
            disc.id = input.id;
            disc.x = input.x;
            disc.y = input.y;
            disc.vx = input.vx / k;
            disc.vy = input.vy / k;
            for (const SideColumn column : all_side_columns)
                if (has_first_numbers(scene, column))
                    numbers[column].push_back(first_number(scene, column, input.id) /
                                              (info_of(column).is_rate ? rate_unit : 1));
        }
    }
    for (const SideColumn column : all_side_columns)
        if (!numbers[column].empty()) state.columns.add(column, std::move(numbers[column]));
    return state;
}

std::unique_ptr<Engine> engine_for(const SceneParameters& scene, StoredState state,
                                   const Communicator& communicator, const Tuning& tuning) {
    if (scene.method == Method::event_driven)
        return make_event_driven_engine(scene, std::move(state), communicator, tuning);
    if (scene.gpu) return make_gpu_engine(scene, std::move(state), communicator, tuning);
    return make_time_stepped_engine(scene, std::move(state), communicator, tuning);
}

/// Estimates the largest speed that is usual in the run, per micro-step. Equal on all ranks.
double usual_speed(const SceneParameters& scene, std::span<const DiscState> own,
                   const Communicator& ranks) {
    const Effects& effects = scene.effects;
    double fastest = 0;
    for (const DiscState& disc : own)
        fastest = std::max({fastest, std::fabs(disc.vx), std::fabs(disc.vy)});
    fastest = ranks.max(fastest) * static_cast<double>(scene.micro_steps);
    for (const Boundary& side : effects.boundaries)
        fastest = std::max({fastest, std::fabs(side.speed), std::sqrt(side.temperature)});
    fastest = std::max({fastest, largest_wall_speed(effects), usual_speed_of_effects(scene)});
    return (fastest > 0 ? fastest : scene.radius) / static_cast<double>(scene.micro_steps);
}

double heaviest_of(const SceneParameters& scene) {
    double heaviest = scene.effects.species.empty() ? 1 : 0;
    for (const Species& one : scene.effects.species) heaviest = std::max(heaviest, one.mass);
    return heaviest;
}

/// Whether the kinetic energy is conserved. Otherwise averages need more samples, and each sample
/// takes two passes over the discs.
bool keep_energy_of_motion(Effects effects) {
    effects.species.clear();
    if (effects.contact.kind == ContactKind::none) effects.contact = {};
    if (effects.fixed_bodies.restitution == 1 && !effects.fixed_bodies.surface.rubs())
        effects.fixed_bodies = {};
    for (Boundary& side : effects.boundaries)
        if (side.kind == BoundaryKind::periodic) side = {};
    return !effects.are_any();
}

AveragedSystem system_to_average(const SceneParameters& scene, std::uint64_t n_discs) {
    AveragedSystem system;
    system.n_discs = static_cast<double>(n_discs);
    system.box = scene.box;
    system.radius = scene.radius;
    system.velocity_unit = static_cast<double>(scene.micro_steps);
    system.micro_steps = scene.micro_steps;
    system.sync_every = scene.sync_every;
    system.is_plain = !scene.effects.are_any();
    system.keeps_discs = !scene.effects.have_open_boundaries();
    system.drift_x = drift_along(Axis::x, scene.effects);
    system.drift_y = drift_along(Axis::y, scene.effects);
    system.has_flow = scene.effects.are_sheared();
    system.keeps_energy = keep_energy_of_motion(scene.effects);
    system.last_step = scene.least_last_step();
    return system;
}

} // namespace

DiscSystem::DiscSystem(const SceneParameters& scene, std::vector<InputDisc> discs,
                       const Communicator& communicator, const Tuning& tuning)
    : DiscSystem(scene, first_state(scene, std::move(discs)), communicator, tuning) {}

DiscSystem::DiscSystem(const SceneParameters& scene, StoredState state,
                       const Communicator& communicator, const Tuning& tuning)
    : communicator_(communicator), velocity_unit_(static_cast<double>(scene.micro_steps)),
      sync_interval_(static_cast<double>(scene.sync_every)), effects_(scene.effects),
      columns_(side_columns_of(scene)), box_(scene.box), n_threads_(tuning.threads),
      heaviest_(heaviest_of(scene)),
      engine_(engine_for(scene, std::move(state), communicator, tuning)),
      averaged_system_(
          std::make_unique<AveragedSystem>(system_to_average(scene, engine_->n_discs()))) {
    // Typical terms are 2^45 units of a sum, and sums may reach 2^80 typical terms. The largest
    // terms come from whole flights. Rare larger terms are added in a slower way.
    const double speed = usual_speed(scene, engine_->own(), communicator),
                 flight = speed * static_cast<double>(longest_flight);
    begin_stress_sums(heaviest_ * std::max(scene.radius, flight) * speed * 0x1p80);
    engine_->begin_loss_sums(heaviest_ * speed * speed * 0x1p80);
}

DiscSystem::~DiscSystem() = default;

void DiscSystem::advance_towards(std::int64_t last_step) {
    if (check_ && step() < last_step)
        advance_checked();
    else // runs to `last_step`, or to the first step that ends at or after a sync
        engine_->advance_towards(last_step);
}

void DiscSystem::begin_stress_sums(double bound) {
    if (stress_ && bound == stress_bound_) return; // the sums have this unit already
    stress_bound_ = bound;
    stress_ = std::make_unique<StressSums>(bound);
    engine_->add_stress_to(stress_.get());
}

const StressSums& DiscSystem::stress_sums() const { return *stress_; }

void DiscSystem::check_every_step(const SceneParameters& scene) {
    check_ = std::make_unique<StateCheck>(scene, species_table(), discs(), micro_steps_done(),
                                          communicator_, frame(), clock(), spins(),
                                          engine_->energy_given());
}

void DiscSystem::advance_checked() {
    std::vector<Collision> collisions;
    double work = 0;
    engine_->log_to(&collisions);
    engine_->add_work_to(&work);
    engine_->advance_towards(step() + 1);
    engine_->log_to(log_);
    engine_->add_work_to(nullptr);
    const LocalView now = engine_->local_view();
    const SideSpans columns = engine_->side_columns();
    check_->inspect(
        now, micro_steps_done(), collisions,
        {columns[SideColumn::spin], columns[SideColumn::swapped_radius], engine_->departed()}, work,
        engine_->energy_given());
    engine_->forget_images();
    if (log_) log_->insert(log_->end(), collisions.begin(), collisions.end());
}

std::int64_t DiscSystem::step() const {
    return micro_steps_done() / static_cast<std::int64_t>(velocity_unit_);
}

std::int64_t DiscSystem::micro_steps_done() const { return engine_->micro_steps_done(); }

std::span<const DiscState> DiscSystem::discs() const {
    if (engine_->departed().empty()) return engine_->own();
    stored_.assign(engine_->own().begin(), engine_->own().end());
    stored_.insert(stored_.end(), engine_->departed().begin(), engine_->departed().end());
    return stored_;
}

SideSpans DiscSystem::side_columns() const {
    if (engine_->departed().empty()) return engine_->side_columns();
    const SideSpans own = engine_->side_columns(), departed = engine_->departed_columns();
    columns_.for_each([&](SideColumn column) {
        std::vector<double> values(own[column].begin(), own[column].end());
        values.insert(values.end(), departed[column].begin(), departed[column].end());
        stored_columns_.add(column, std::move(values));
    });
    return stored_columns_.spans();
}

Frame DiscSystem::frame() const { return engine_->frame(); }

std::span<const DiscState> DiscSystem::shown() const {
    const Frame now = frame();
    if (!now.is_moving) return discs();
    const std::span<const DiscState> stored = discs();
    const double time = clock();
    shown_.resize(stored.size());
    for (std::size_t i = 0; i < stored.size(); ++i) shown_[i] = now.in_box(stored[i], time);
    return shown_;
}

std::span<const DiscState> DiscSystem::in_motion() const {
    return frame().keeps_velocities() ? discs() : shown();
}

std::span<const DiscState> DiscSystem::in_flow() const {
    if (!effects_.are_sheared()) return in_motion();
    static_cast<void>(shown());
    for (DiscState& disc : shown_) disc.vx -= effects_.flow_at(disc.y, box_) / velocity_unit_;
    return shown_;
}

double DiscSystem::clock() const { return engine_->clock(); }

std::uint64_t DiscSystem::n_discs() const { return engine_->n_discs(); }

Extent DiscSystem::box() const {
    return extent_at(effects_, engine_->box(), static_cast<double>(step()));
}

void DiscSystem::log_to(std::vector<Collision>* log) {
    log_ = log;
    engine_->log_to(log);
}

Totals DiscSystem::totals() const {
    Totals totals = energies();
    measure_collisions(discs(), side_columns(), communicator_, n_threads_, totals);
    measure_departures(discs(), box_, communicator_, totals);
    engine_->add_to(totals);
    return totals;
}

const SpeciesTable& DiscSystem::species_table() const { return engine_->species_table(); }

const SpeciesTable* DiscSystem::species_if_mixed() const {
    return effects_.species.empty() ? nullptr : &species_table();
}

Totals DiscSystem::energies() const {
    Totals totals;
    totals.n_discs = engine_->n_discs();
    measure_motion(in_motion(), species_if_mixed(), velocity_unit_, communicator_, n_threads_,
                   totals);
    if (const std::vector<OtherEnergy> others = other_energies_of(effects_); !others.empty())
        measure_other_energies(others, shown(), spins(), species_table(),
                               {effects_, box_, velocity_unit_, sync_interval_}, communicator_,
                               totals);
    return totals;
}

} // namespace carrom

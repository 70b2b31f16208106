// SPDX-License-Identifier: BSD-3-Clause
#include "engine/sync_action.hpp"

#include <algorithm>

#include <omp.h>

#include "core/errors.hpp"
#include "scene/effects/effect.hpp"

namespace carrom {

namespace {

/// Calls `go_on(effect, numbers)` for each effect with the numbers that it kept.
template <class GoOn>
void restore(const SyncEffects& effects, std::span<const std::int64_t> kept, const GoOn& go_on) {
    if (kept.empty()) return;
    for (const auto& effect : effects) {
        if (kept.empty()) throw CollectiveError("the state has no numbers of some effect");
        const auto n = static_cast<std::size_t>(kept.front());
        kept = kept.subspan(1);
        if (n > kept.size()) throw CollectiveError("the state has too few numbers of an effect");
        go_on(*effect, kept.first(n));
        kept = kept.subspan(n);
    }
}

ShapeChange* shape_of(const SyncEffects& effects) {
    for (const auto& effect : effects)
        if (ShapeChange* const its = effect->shape()) return its;
    return nullptr;
}

} // namespace

SyncAction::SyncAction(const SceneParameters& scene, const SpeciesTable& species,
                       const Communicator& communicator, int n_threads)
    : effects_(sync_effects_of(scene)), species_(species), inertia_(scene.effects.contact.inertia),
      micro_steps_(static_cast<double>(scene.micro_steps)), box_(scene.box),
      shear_(scene.effects.are_sheared()
                 ? scene.effects.shear / static_cast<double>(scene.micro_steps)
                 : 0),
      communicator_(communicator), n_threads_(n_threads) {
    for (const auto& effect : effects_) effect->learn(species_);
}

double SyncAction::reach(std::int64_t n_syncs) const {
    double largest = 0;
    for (const auto& effect : effects_) largest = std::max(largest, effect->reach(n_syncs));
    return largest;
}

SyncDiscs SyncAction::at_sync(StripDiscs& discs, std::int64_t n_syncs) const {
    SyncDiscs at{species_};
    at.discs = discs.own();
    if (discs.columns().has(SideColumn::spin)) at.spins = discs.columns()[SideColumn::spin];
    if (discs.columns().has(SideColumn::direction))
        at.directions = discs.columns()[SideColumn::direction];
    if (discs.columns().has(SideColumn::swapped_radius))
        at.radii = discs.columns()[SideColumn::swapped_radius];
    at.n_syncs = n_syncs;
    at.in_parts = [this, n = at.discs.size()](const SyncDiscs::Part& part) {
#pragma omp parallel num_threads(n_threads_)
        {
            const auto thread = static_cast<std::size_t>(omp_get_thread_num()),
                       n_parts = static_cast<std::size_t>(omp_get_num_threads());
            part(n * thread / n_parts, n * (thread + 1) / n_parts);
        }
    };
    at.add_over_ranks = [this](std::span<ExactSum> sums) {
        for (ExactSum& sum : sums) communicator_.sum(sum);
    };
    at.largest_over_ranks = [this](double value) { return communicator_.max(value); };
    at.gather_over_ranks = [this](std::span<const std::byte> mine) { return gathered(mine); };
    return at;
}

template <class What> void SyncAction::change(const SyncDiscs& at, const What& what) {
    energy_given_ -= energy_of(at);
    if (shear_ != 0) add_flow(at, -1);
    for (const auto& effect : effects_) what(*effect);
    if (shear_ != 0) add_flow(at, 1);
    energy_given_ += energy_of(at);
}

void SyncAction::act(StripDiscs& discs, std::int64_t n_syncs, const SyncNotes& notes,
                     const std::function<void(const SyncDiscs::VisitNear&)>& visit_near_pairs) {
    SyncDiscs at = at_sync(discs, n_syncs);
    at.visit_near_pairs = visit_near_pairs;
    if (communicator_.is_root()) follow(at, notes);
    change(at, [&at](SyncEffect& effect) { effect.act(at); });
}

bool SyncAction::begins() const {
    return std::ranges::any_of(effects_, [](const auto& effect) { return effect->begins(); });
}

void SyncAction::begin(StripDiscs& discs, std::int64_t n_syncs) {
    const SyncDiscs at = at_sync(discs, n_syncs);
    change(at, [&at](SyncEffect& effect) { effect.begin(at); });
}

std::vector<std::int64_t> SyncAction::kept() const {
    std::vector<std::int64_t> all;
    for (const auto& effect : effects_) {
        const std::vector<std::int64_t> one = effect->kept();
        all.push_back(static_cast<std::int64_t>(one.size()));
        all.insert(all.end(), one.begin(), one.end());
    }
    return all.size() > effects_.size() ? all : std::vector<std::int64_t>{};
}

void SyncAction::go_on(std::span<const std::int64_t> kept) {
    restore(effects_, kept, [](SyncEffect& effect, std::span<const std::int64_t> numbers) {
        effect.go_on(numbers);
    });
}

ShapeChange* SyncAction::shape() const { return shape_of(effects_); }

/// Only the effect that changes sides gets its numbers: others would need the species first.
Box SyncAction::box_at(const SceneParameters& scene, std::span<const std::int64_t> kept) {
    const SyncEffects effects = sync_effects_of(scene);
    const ShapeChange* const shape = shape_of(effects);
    if (!shape) return scene.box;
    restore(effects, kept, [](SyncEffect& effect, std::span<const std::int64_t> numbers) {
        if (effect.shape()) effect.go_on(numbers);
    });
    return shape->box();
}

void SyncAction::follow(SyncDiscs& at, const SyncNotes& notes) const {
    if (notes.walls->are_any())
        at.record_wall = [this, walls = notes.walls](const WallImpulse& impulse) {
            WallEvent event;
            if (impulse.side < WallImpulse::n_sides)
                event.side = static_cast<std::uint8_t>(impulse.side);
            else
                event.body = static_cast<std::uint32_t>(impulse.side - WallImpulse::n_sides);
            event.ix = impulse.ix * micro_steps_;
            event.iy = impulse.iy * micro_steps_;
            event.torque = impulse.torque * micro_steps_;
            event.normal = impulse.normal * micro_steps_;
            event.along = impulse.along * micro_steps_;
            event.energy = impulse.energy * micro_steps_ * micro_steps_;
            event.is_lasting = true;
            walls->give({&event, 1});
        };
    if (notes.stress == nullptr && !notes.pairs->are_any()) return;
    at.record_pair = [this, notes](const PairImpulse& pair) {
        if (notes.stress != nullptr) {
            StressTerms terms;
            terms.add(pair.ix, pair.iy, {pair.dx, pair.dy}, *notes.stress);
            terms.add_to(*notes.stress);
        }
        if (!notes.pairs->are_any()) return;
        const PairEvent event = event_of(pair, notes.micro_step);
        notes.pairs->give({&event, 1});
    };
}

/// Followers compute the mean velocity in an event as the velocity afterwards minus half its
/// change. `pair` already has mean velocities, so half of the change is added to them here.
PairEvent SyncAction::event_of(const PairImpulse& pair, std::int64_t micro_step) const {
    const double p_share = 0.5 / species_.of(pair.p).mass, q_share = 0.5 / species_.of(pair.q).mass;
    PairEvent event;
    event.p = pair.p, event.q = pair.q;
    event.micro_step = micro_step;
    event.x = pair.x, event.y = pair.y;
    event.dx = pair.dx, event.dy = pair.dy;
    event.ix = pair.ix * micro_steps_, event.iy = pair.iy * micro_steps_;
    event.p_vx = (pair.p_vx + p_share * pair.ix) * micro_steps_;
    event.p_vy = (pair.p_vy + p_share * pair.iy) * micro_steps_;
    event.q_vx = (pair.q_vx - q_share * pair.ix) * micro_steps_;
    event.q_vy = (pair.q_vy - q_share * pair.iy) * micro_steps_;
    return event;
}

std::vector<std::byte> SyncAction::gathered(std::span<const std::byte> mine) const {
    std::vector<std::byte> all;
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        std::vector<std::byte> part;
        if (rank == communicator_.rank()) part.assign(mine.begin(), mine.end());
        communicator_.broadcast(part, rank);
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

/// The flow vx = rate (y - Ly / 2) turns clockwise with an angular velocity of half the rate.
void SyncAction::add_flow(const SyncDiscs& at, double times) const {
    const double rate = times * shear_;
    for (DiscState& disc : at.discs) disc.vx += rate * (disc.y - box_.y / 2);
    for (double& spin : at.spins) spin -= rate / 2;
}

double SyncAction::energy_of(const SyncDiscs& at) const {
    double energy = 0;
    for (std::size_t i = 0; i < at.discs.size(); ++i) {
        const SizeAndMass& body = species_.of(at.discs[i].id);
        const double turning = at.spins.empty() ? 0 : body.radius * at.spins[i];
        energy += 0.5 * body.mass * (squared_speed_of(at.discs[i]) + inertia_ * turning * turning);
    }
    return energy;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
#include "engine/sync_action.hpp"

#include <omp.h>

#include "scene/effects/effect.hpp"

namespace carrom {

SyncAction::SyncAction(const SceneParameters& scene, const SpeciesTable& species,
                       const Communicator& communicator, int n_threads)
    : effects_(sync_effects_of(scene)), species_(species), inertia_(scene.effects.contact.inertia),
      box_(scene.box), shear_(scene.effects.are_sheared()
                                  ? scene.effects.shear / static_cast<double>(scene.micro_steps)
                                  : 0),
      communicator_(communicator), n_threads_(n_threads) {}

void SyncAction::act(StripDiscs& discs, std::int64_t n_syncs) {
    SyncDiscs at{species_};
    at.discs = discs.own();
    if (discs.columns().has(SideColumn::spin)) at.spins = discs.columns()[SideColumn::spin];
    at.n_syncs = n_syncs;
    at.in_parts = [&](const SyncDiscs::Part& part) {
        const std::size_t n = at.discs.size();
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

    energy_given_ -= energy_of(at);
    if (shear_ != 0) add_flow(at, -1);
    for (const auto& effect : effects_) effect->act(at);
    if (shear_ != 0) add_flow(at, 1);
    energy_given_ += energy_of(at);
}

/// vx = rate (y - Ly / 2) turns clockwise at half the rate.
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

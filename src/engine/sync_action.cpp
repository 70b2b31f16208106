// SPDX-License-Identifier: BSD-3-Clause
#include "engine/sync_action.hpp"

#include <algorithm>
#include <cmath>

#include <omp.h>

#include "scene/effects/effect.hpp"

namespace carrom {

SyncAction::SyncAction(const Scene& scene, const Communicator& communicator, int n_threads)
    : effects_(sync_effects_of(scene)), species_(scene.effects.species, scene.radius),
      inertia_(scene.effects.contact.inertia), communicator_(communicator), n_threads_(n_threads) {}

double SyncAction::act(StripDiscs& discs, std::int64_t n_syncs) {
    SyncDiscs at;
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
    for (const auto& effect : effects_) effect->act(at);
    energy_given_ += energy_of(at);
    double fastest = 0;
    for (const Disc& disc : at.discs) fastest = std::max(fastest, squared_speed_of(disc));
    return std::sqrt(fastest);
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

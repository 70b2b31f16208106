// SPDX-License-Identifier: BSD-3-Clause
// What stands behind a public Simulation.
#pragma once

#include <optional>
#include <vector>

#include <carrom/simulation.hpp>

#include "measure/sampler.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace carrom::api {

struct Simulation::State {
    /// Begins anew from `discs`. **Collective.**
    State(const Communicator& all, carrom::Scene checked, std::vector<InputDisc> discs,
          const Tuning& tuning);
    /// Goes on from `stored`. **Collective.**
    State(const Communicator& all, carrom::Scene checked, StoredState stored, StoredSamples samples,
          const Tuning& tuning);
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    Communicator ranks;
    carrom::Scene scene;
    SceneFacts facts;
    int n_threads;
    carrom::Simulation simulation;
    std::optional<Sampler> sampler; ///< where the scene asks for measurements
};

} // namespace carrom::api

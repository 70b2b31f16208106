// SPDX-License-Identifier: BSD-3-Clause
// The inside of a public Simulation.
#pragma once

#include <optional>

#include <carrom/simulation.hpp>

#include "parallel/communicator.hpp"
#include "run/checkpoints.hpp"
#include "run/run.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct Simulation::State {
    /// **Collective.**
    State(SceneParameters checked, RunStart start, const Communicator& ranks, const Tuning& tuning,
          const Messages& messages);
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    Run run;
    SceneFacts facts;
    std::optional<Checkpoints> checkpoints; ///< from keep_checkpoints on
};

} // namespace carrom

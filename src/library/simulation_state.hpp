// SPDX-License-Identifier: BSD-3-Clause
// The State of a public Simulation.
#pragma once

#include <memory>
#include <optional>

#include <carrom/simulation.hpp>

#include "engine/tuning.hpp"
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

    Run& run() const { return *run_; }
    /// Replaces the state at the present step by `start`. If `most_overlaps` is set and more pairs
    /// overlap in `start`, throws InputError and changes nothing. **Collective.**
    void replace(RunStart start, std::optional<std::uint64_t> most_overlaps);
    /// **Collective.**
    void keep_checkpoints(CheckpointOutput wanted);

    bool keeps_checkpoints() const { return checkpoints_.has_value(); }

    SceneFacts facts;
    Tuning tuning;

private:
    /// Reads crossings of periodic sides regularly, so that they do not fill the memory.
    struct ImageReading final : StepAction {
        explicit ImageReading(Run& of) : run(of) {}
        std::int64_t next_due(std::int64_t) const override;
        bool act() override;

        Run& run;
        std::int64_t last_step = 0;
    };

    void read_images_often();

    std::unique_ptr<Run> run_; ///< replaced when discs are changed
    std::optional<ImageReading> image_reading_;
    std::optional<CheckpointOutput> wanted_checkpoints_;
    std::optional<Checkpoints> checkpoints_; ///< set by keep_checkpoints
};

/// The present state of a run, from which another run can start. **Collective.**
RunStart stored_start(Run& run);

/// The scene of a run, with the chosen method and micro-steps in place of `time.accuracy`.
SceneParameters scene_to_go_on(const Run& run);

} // namespace carrom

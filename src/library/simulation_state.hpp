// SPDX-License-Identifier: BSD-3-Clause
// The inside of a public Simulation.
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
    /// Goes on with that state at the present step instead. Throws InputError if more pairs than
    /// `most_overlaps` overlap, and nothing has changed then. **Collective.**
    void replace(RunStart start, std::optional<std::uint64_t> most_overlaps);
    /// **Collective.**
    void keep_checkpoints(CheckpointOutput wanted);

    bool keeps_checkpoints() const { return checkpoints_.has_value(); }

    SceneFacts facts;
    Tuning tuning;

private:
    /// Keeps crossings of periodic sides from filling the memory where nobody reads the images.
    struct ImageReading final : StepAction {
        explicit ImageReading(Run& of) : run(of) {}
        std::int64_t next_due(std::int64_t) const override;
        bool act() override;

        Run& run;
        std::int64_t last_step = 0;
    };

    void read_images_often();

    std::unique_ptr<Run> run_; ///< another one once discs were changed
    std::optional<ImageReading> image_reading_;
    std::optional<CheckpointOutput> wanted_checkpoints_;
    std::optional<Checkpoints> checkpoints_; ///< from keep_checkpoints on
};

/// The present state of a run, to go on from in memory. **Collective.**
RunStart stored_start(Run& run);

/// The scene of a run at its present state, without what was only for its start.
SceneParameters scene_to_go_on(const Run& run);

} // namespace carrom

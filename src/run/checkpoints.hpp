// SPDX-License-Identifier: BSD-3-Clause
// Decides when a run stores its state, and which of the stored states it keeps.
//
// After each stretch of steps ranks agree on two questions: does a batch system want
// the run to stop, and does wall time ask for a checkpoint? Stretches are kept to half
// a second if steps are slow. Price: one reduction a stretch, also in a run without
// checkpoints, because it may be asked to stop.
//
// A step that takes longer than a second after a request is given up, and leaves no
// state. So smaller runs keep a copy of a state from shortly before, which is written
// then. They copy so rarely that it costs about a hundredth of the time.
#pragma once

#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "core/stopwatch.hpp"
#include "io/checkpoint.hpp"
#include "parallel/communicator.hpp"
#include "run/run.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

class Checkpoints : public StepAction {
public:
    /// Stores the state of `run` in the folder of `wanted`. Without `wanted` it only
    /// sees requests to stop. A run that has gone on from a checkpoint of that folder has one
    /// of its first step. `run` must outlive this. **Collective.**
    Checkpoints(Run& run, std::optional<CheckpointOutput> wanted);
    ~Checkpoints() {
        if (removal_.valid()) removal_.wait();
    }
    Checkpoints(const Checkpoints&) = delete;
    Checkpoints& operator=(const Checkpoints&) = delete;

    /// Includes steps that come soon enough to see a request to stop.
    std::int64_t next_due(std::int64_t step) const override;

    /// Stores the state if it is time, after the other actions have done their work up
    /// to there. Returns false if the run is asked to stop before its end; its state
    /// is stored then, if it has a folder. If storing fails every rank throws, and
    /// older checkpoints are unchanged. **Collective.**
    bool act() override;

    /// After a step that was given up for a request to stop: stores the last state that there
    /// is a copy of. Returns a sentence on where the run can go on from. **Collective.**
    std::string write_copy();

    /// After discs have jammed: stores the end of `step`, to which the run comes without a jam.
    /// Returns a sentence that names the file and the packing in it. **Collective.**
    std::string keep(std::int64_t step);

private:
    struct Copy {
        CheckpointHeader header;
        DiscStates discs;
        SideColumns columns;
        StoredSamples samples;
    };
    struct Updates {
        bool must_stop = false, is_time = false, is_copy_due = false;
    };
    Updates updates(std::int64_t step);
    void write();
    void copy();
    void go_over_to(std::int64_t step);
    void note_written(const std::string& path, std::int64_t step);
    void remove_oldest();

    Run& run_;
    const Communicator& ranks_;
    std::optional<CheckpointOutput> wanted_;
    std::int64_t last_agreed_, last_written_ = -1;
    std::int64_t stretch_ = 1; ///< until ranks agree again, by rank 0's clock
    Stopwatch stretch_watch_;
    double seconds_since_written_ = 0; ///< on rank 0's clock
    double seconds_since_copied_ = 0;  ///< on rank 0's clock
    std::optional<Copy> copy_;         ///< a state before the last one written, or none
    std::vector<std::string> kept_;    ///< paths, oldest first
    std::future<void> removal_;        ///< removes older checkpoints, on rank 0
};

} // namespace carrom

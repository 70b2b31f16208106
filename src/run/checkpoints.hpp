// SPDX-License-Identifier: BSD-3-Clause
// Decides when a run stores its state, and which stored states it keeps.
//
// After each stretch of steps ranks agree on two questions: has a signal requested a stop, and is a
// checkpoint due by wall time? A stretch takes half a second, or one longer step. Cost:
// one reduction a stretch, also without checkpoints, because the run may have to stop.
//
// A step that lasts longer than a second after a request to stop is abandoned, and leaves no
// consistent state. So runs keep a copy of a recent state, which is then written; copies take about
// 1 % of the time of a run. Runs with many discs a rank make no copies, but wait longer.
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
    /// Stores the state of `run` in the folder of `wanted`. Without `wanted` it only handles
    /// requests to stop. A run that restarted from a checkpoint of that folder does not
    /// store its first step again. `run` must outlive this. **Collective.**
    Checkpoints(Run& run, std::optional<CheckpointOutput> wanted);
    ~Checkpoints() {
        if (removal_.valid()) removal_.wait();
    }
    Checkpoints(const Checkpoints&) = delete;
    Checkpoints& operator=(const Checkpoints&) = delete;

    /// The next step after `step` at which a checkpoint or a test for a request to stop is due.
    std::int64_t next_due(std::int64_t step) const override;

    /// Stores the state if a checkpoint is due, after the other actions have made their data
    /// permanent. Returns false if a stop was requested before the end; the state is then stored,
    /// if there is a folder. If storing fails every rank throws, and older checkpoints are
    /// unchanged. **Collective.**
    bool act() override;

    /// Call it after a step was abandoned because of a request to stop. Writes the last copy of a
    /// state to the folder, if there is one. Returns a sentence about the state from which the run
    /// can continue. **Collective.**
    std::string write_copy();

    /// Call it after discs have jammed. Stores the state at the end of `step`, before the jam.
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
    void record_written(const std::string& path, std::int64_t step);
    void remove_oldest();

    Run& run_;
    const Communicator& ranks_;
    std::optional<CheckpointOutput> wanted_;
    std::int64_t last_agreed_, last_written_ = -1;
    std::int64_t stretch_ = 1; ///< steps until ranks agree again, measured with rank 0's clock
    Stopwatch stretch_watch_;
    double seconds_since_written_ = 0; ///< seconds by rank 0's clock
    double seconds_since_copied_ = 0;  ///< seconds by rank 0's clock
    std::optional<Copy> copy_;         ///< copy of a state after the last written one
    std::vector<std::string> kept_;    ///< paths of the checkpoints, oldest first
    std::future<void> removal_;        ///< removal of older checkpoints by rank 0
};

} // namespace carrom

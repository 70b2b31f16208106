// SPDX-License-Identifier: BSD-3-Clause
// When a run stores its state, and which of the stored ones it keeps.
//
// Ranks agree after each stretch of steps: whether a batch system wants the run to stop,
// and whether wall time asks for a checkpoint. Stretches are kept to half a second where steps are
// slow. Price: one reduction a stretch, where the scene asks for no checkpoints too: it may still
// be told to stop.
//
// A step that takes longer than a second after a request is given up, and no state is left. So
// smaller runs keep a copy of a state from shortly before, to be written then. They take it so
// rarely that it costs some hundredth of the time.
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
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

class Checkpoints : public StepAction {
public:
    /// Stores the state of `run` in a folder if that is `wanted`; else it sees requests to stop
    /// alone. A run that has gone on from a checkpoint has one of its first step. `run` must
    /// outlive this. **Collective.**
    Checkpoints(Run& run, std::optional<CheckpointOutput> wanted);
    ~Checkpoints() {
        if (removal_.valid()) removal_.wait();
    }
    Checkpoints(const Checkpoints&) = delete;
    Checkpoints& operator=(const Checkpoints&) = delete;

    /// Also a step that comes soon enough to see a request to stop.
    std::int64_t next_due(std::int64_t step) const override;

    /// Stores the state if it is time, after what the other actions have done up to there. Returns
    /// false if the run is asked to stop before its end; its state is stored then, if it has a
    /// folder. If storing fails every rank throws, and the older checkpoints are as they
    /// were. **Collective.**
    bool act() override;

    /// After a step that was given up for a request to stop: stores the last state that there is a
    /// copy of. Says where the run can go on from. **Collective.**
    std::string write_copy();

private:
    struct Copy {
        CheckpointHeader header;
        std::vector<Disc> discs;
        SideColumns columns;
        StoredSamples samples;
    };
    struct Updates {
        bool must_stop = false, is_time = false, is_copy_due = false;
    };
    Updates updates(std::int64_t step);
    void write();
    void copy();
    void note_written(const std::string& path, std::int64_t step);
    void remove_oldest();

    Run& run_;
    const Communicator& ranks_;
    std::optional<CheckpointOutput> wanted_;
    std::int64_t last_agreed_, last_written_ = -1;
    std::int64_t stretch_ = 1; ///< steps until ranks agree again, as rank 0 has measured
    Stopwatch stretch_watch_;
    double seconds_since_written_ = 0; ///< on rank 0's clock
    double seconds_since_copied_ = 0;  ///< the same
    std::optional<Copy> copy_;         ///< of an earlier state than the last one written, or none
    std::vector<std::string> kept_;    ///< paths, oldest first
    std::future<void> removal_;        ///< of older ones, by rank 0
};

} // namespace carrom

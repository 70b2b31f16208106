// SPDX-License-Identifier: BSD-3-Clause
// When a run stores its state, and which of the stored ones it keeps.
//
// Ranks look up together after each stretch of steps: whether a batch system wants the run to stop,
// and whether wall time asks for a checkpoint. Stretches are kept to half a second where steps are
// slow. Price: one reduction a stretch, where the scene asks for no checkpoints too: it may still
// be told to stop.
//
// A step that takes longer than a second after a request is given up, and no state is left. So
// smaller runs keep a copy of a state from shortly before, to be written then. They take it so
// rarely that it costs some hundredth of the time.
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "io/checkpoint.hpp"
#include "parallel/communicator.hpp"
#include "run/recordings.hpp"
#include "run/stopwatch.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

class Checkpoints {
public:
    /// `first_step` is where the run begins; `is_restart` if it has a checkpoint of that step.
    /// `must_stop` says whether this rank has been told to stop. References must outlive this.
    Checkpoints(const Scene& scene, std::int64_t first_step, bool is_restart,
                std::function<bool()> must_stop, const Communicator& ranks, int n_threads);
    ~Checkpoints() {
        if (removal_.valid()) removal_.wait();
    }
    Checkpoints(const Checkpoints&) = delete;
    Checkpoints& operator=(const Checkpoints&) = delete;

    /// Up to which step to go before looking up again.
    std::int64_t next_look(std::int64_t step) const;

    /// Looks up after a stretch of steps and stores the state if it is time, after what is recorded
    /// up to there. True if the run is to stop here; its state is stored then, if the scene has a
    /// folder for it. If storing fails every rank throws, and the older checkpoints are as they
    /// were. **Collective.**
    bool look_up(const Simulation& simulation, Recordings& recordings);

    /// After a step that was given up for a request to stop: stores the last state that there is a
    /// copy of. Says where the run can go on from. **Collective.**
    std::string write_copy(Recordings& recordings);

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
    void write(const Simulation& simulation, Recordings& recordings);
    void copy(const Simulation& simulation, Recordings& recordings);
    StoredSamples samples_now(const Simulation& simulation, Recordings& recordings) const;
    void note_written(const std::string& path, std::int64_t step);
    void remove_oldest();

    const Communicator& ranks_;
    const Scene& scene_;
    std::function<bool()> must_stop_;
    int n_threads_;
    std::int64_t last_looked_, last_written_ = -1;
    std::int64_t stretch_ = 1; ///< steps until the next look, as rank 0 has measured
    Stopwatch stretch_watch_;
    double seconds_since_written_ = 0; ///< on rank 0's clock
    double seconds_since_copied_ = 0;  ///< the same
    std::optional<Copy> copy_;         ///< of an earlier state than the last one written, or none
    std::vector<std::string> kept_;    ///< paths, oldest first
    std::future<void> removal_;        ///< of older ones, by rank 0
};

} // namespace carrom

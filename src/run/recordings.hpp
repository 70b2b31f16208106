// SPDX-License-Identifier: BSD-3-Clause
// What a run records as it goes on, if its scene asks for it: a trajectory, the collisions in their
// total order, and measurements, whose tables are written with each checkpoint and at the end. The
// table "thermo" is written as it grows.
//
// They are committed before each checkpoint, and every few seconds for readers.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/collision_log.hpp"
#include "io/trajectory.hpp"
#include "measure/image_counts.hpp"
#include "measure/sampler.hpp"
#include "parallel/communicator.hpp"
#include "run/measured_files.hpp"
#include "run/messages.hpp"
#include "run/stopwatch.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

/// A collision as the log shows it: the step it is made in, and its time since the scene's start,
/// in steps.
LoggedCollision logged(const Collision& collision, std::int64_t micro_steps);

class Recordings {
public:
    /// Opens the files; cut back to the present step in a restart, else new ones with the present
    /// step as a first frame. From then on the simulation logs its collisions here: this must
    /// outlive its stepping. **Collective.**
    Recordings(const Scene& scene, Simulation& simulation, bool is_restart, StoredSamples samples,
               const Communicator& ranks, const Messages& messages);

    /// The next step after `step` that is to be recorded.
    std::int64_t next_due(std::int64_t step) const;

    /// To be called after each stretch of steps. If recording fails every rank throws.
    /// **Collective.**
    void record(const Simulation& simulation);

    /// What is recorded so far is to stay. **Collective.**
    void commit();

    /// The same, at the end of the run. **Collective.**
    void finish();

    /// What a checkpoint has to keep of measurements and image counts. **Collective.**
    StoredSamples samples();
    std::vector<MeasuredTable> tables() const {
        return sampler_ ? sampler_->tables() : std::vector<MeasuredTable>{};
    }

private:
    void report_missing_frames(std::int64_t last, std::int64_t step) const;
    void record_collisions();
    void sample();
    void commit_now_and_then();

    const Scene& scene_;
    const Communicator& ranks_;
    const Messages& messages_;
    std::optional<Trajectory> trajectory_;
    std::optional<CollisionLog> log_;
    std::optional<Sampler> sampler_;
    GrowingFiles growing_;
    std::optional<ImageCounts> images_;
    Stopwatch since_look_;
    double seconds_uncommitted_ = 0, commit_seconds_ = 0; ///< on rank 0's clock
    std::vector<Collision> collisions_; ///< of this rank since they were last recorded
};

} // namespace carrom

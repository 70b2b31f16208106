// SPDX-License-Identifier: BSD-3-Clause
// The recordings of a run that its scene requires: a trajectory, the collisions in their total
// order, and measurements. Each commit writes the tables of measurements anew. The table "thermo"
// is written as it grows.
//
// Data are committed before each checkpoint, at the end, and about once a second, so that other
// programs can read them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/stopwatch.hpp"
#include "io/collision_log.hpp"
#include "io/trajectory.hpp"
#include "parallel/communicator.hpp"
#include "run/measured_files.hpp"
#include "run/messages.hpp"
#include "run/run.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The collision as the log stores it: with its step, and its time since step 0 in steps.
LoggedCollision logged(const Collision& collision, std::int64_t micro_steps);

class Recordings : public StepAction {
public:
    /// In a restart, opens the files and checks that the run can continue them; if not, throws
    /// (exit code 2). Writes nothing yet. From here on the simulation collects its collisions for
    /// the log. All arguments must outlive this object, which must outlive the run's steps.
    /// **Collective.**
    Recordings(Run& run, const Messages& messages);

    /// In a restart, cuts the files back to the present step; otherwise makes new files with the
    /// present step as the first frame. Call it before any step. **Collective.**
    void begin();

    std::int64_t next_due(std::int64_t step) const override;
    /// Records the present step. If recording fails every rank throws. **Collective.**
    bool act() override;
    /// Makes everything recorded so far permanent. **Collective.**
    void commit() override;

    /// Commits at the end of the run, and describes all frames in XDMF. **Collective.**
    void finish();

private:
    void open_trajectory();
    void open_log();
    void report_loss(const std::string& file, std::int64_t recorded) const;
    void report_missing_frames(std::int64_t last, std::int64_t step) const;
    void record_collisions(std::int64_t step);
    void add_rows();
    void commit_now_and_then();

    Run& run_;
    const SceneParameters& scene_;
    const Communicator& ranks_;
    const Messages& messages_;
    std::optional<Trajectory> trajectory_;
    std::optional<CollisionLog> log_;
    GrowingFiles growing_;
    Stopwatch since_asked_;
    double seconds_uncommitted_ = 0, commit_seconds_ = 0; ///< seconds by rank 0's clock
    std::vector<Collision> collisions_; ///< collisions of this rank that are not recorded yet
};

} // namespace carrom

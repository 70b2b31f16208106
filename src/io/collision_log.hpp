// SPDX-License-Identifier: BSD-3-Clause
// Every collision of a run in one HDF5 file. The collisions of all ranks are sorted by time, with a
// fixed order for equal times.
//
// Columns of /carrom/collisions: step (in which the collision happens, from 1), time (in steps,
// since step 0), p, q (-1: a wall), impulse. Box, radii and masses are in /particles/discs. All
// ranks send their rows in order to rank 0, which writes them; trajectory.hpp gives the reason for
// this, and describes errors.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "io/recorded_system.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

struct LoggedCollision {
    std::int64_t step = 0;
    double time = 0;
    std::int64_t p = 0, q = 0;
    double impulse = 0;
};

/// The steps whose collisions a log contains: all steps up to `last`, except the gaps.
struct LoggedSteps {
    std::int64_t last = 0;
    std::vector<std::int64_t> gaps; ///< the first and the last step of each gap
};

class SegmentedFile;

class CollisionLog {
public:
    /// `communicator` must outlive this.
    CollisionLog(const std::string& path, const RecordedSystem& system,
                 const Communicator& communicator);
    ~CollisionLog();

    /// These two work as in Trajectory. `go_on` returns, on every rank, whether there was a file.
    /// Steps up to `step` that the file lacks become a gap, which the file lists. **Collective.**
    void begin();
    bool go_on(std::int64_t step);
    /// The last step in the file before `go_on` has removed later steps, on rank 0; -1 if unknown.
    std::int64_t recorded_before() const { return recorded_before_; }
    void commit();

    /// The first and the last step of each gap, on rank 0.
    const std::vector<std::int64_t>& gaps() const { return steps_.gaps; }

    /// Appends the collisions of all ranks up to `step`, first those of rank 0, then rank 1 and so
    /// on. They must be later than all collisions in the file. **Collective.**
    void append(std::span<const LoggedCollision> mine, std::int64_t step);

private:
    LoggedSteps steps_;
    std::int64_t recorded_before_ = -1;
    std::unique_ptr<SegmentedFile> file_;
    const Communicator& communicator_;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Frames of a run at regular steps as H5MD, with discs in order of id.
//
// Frames pass through rank 0 in slabs of ids. So a kill does not damage them, and they can be read
// during the run (SegmentedFile), but they are written only as fast as one rank can. An XDMF
// description for ParaView and VisIt is written beside the file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/computed_fields.hpp"
#include "core/disc_state.hpp"
#include "core/side_columns.hpp"
#include "core/stored_samples.hpp"
#include "io/checkpoint.hpp"
#include "io/recorded_system.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

struct TrajectoryLayout {
    RecordedSystem system;
    double velocity_unit = 1; ///< factor from stored velocities to velocities per step
    bool has_position = true, has_velocity = true, has_collisions = false;
    bool has_image = false;
    ComputedFieldSet computed{}; ///< computed fields in each frame
    SideColumnSet columns;       ///< side columns (core/side_columns.hpp) in each frame
    bool is_single = true;       ///< numbers are float32 instead of float64
    /// Description of the run; if its scene text is empty, the file does not describe its run
    CheckpointHeader run;
};

class SegmentedFile;

class Trajectory {
public:
    /// `communicator` must outlive this.
    Trajectory(const std::string& path, const TrajectoryLayout& layout,
               const Communicator& communicator);
    ~Trajectory();

    /// Replaces any other file by a new one. If this or another collective call fails, every rank
    /// throws CollectiveError, exit code 4; the file stays as at the last commit. **Collective.**
    void begin();

    /// Continues the file, cut back to frames up to `step`, or makes a new one if there is none.
    /// Reads all of it; throws with exit code 2 if its layout differs or it is damaged. Nothing
    /// changes on disk before `commit`, which must come before frames are added. Returns on rank 0
    /// the step of the last remaining frame, or -1. **Collective.**
    std::int64_t go_on(std::int64_t step, const DifferenceFrom& difference_from = {});
    /// The step of the last frame before `go_on` has cut the file back, on rank 0; -1 if there was
    /// none.
    std::int64_t recorded_before() const { return recorded_before_; }

    /// Adds a frame: the discs at `clock`, in any distribution over the ranks. Columns and computed
    /// numbers of the layout, if any, are in the order of `discs`. If the layout has images, each
    /// rank passes the images of a range of ids, which follows the range of the previous rank. If
    /// `box` is null, the frame has the layout's box. **Collective.**
    void append(std::int64_t step, std::span<const DiscState> discs, double clock,
                const SideSpans& columns = {},
                std::span<const ComputedNumbers> computed_numbers = {},
                std::span<const DiscImage> images = {}, const Box* box = nullptr);

    /// Makes all frames so far permanent and visible to readers. Also rewrites the XDMF description
    /// if it lacks many frames. **Collective.**
    void commit();

    /// Describes all frames in XDMF, for tools based on VTK. **Collective.**
    void describe();

private:
    std::string path_;
    TrajectoryLayout layout_;
    const Communicator& communicator_;
    std::unique_ptr<SegmentedFile> file_;
    std::vector<std::int64_t> steps_; ///< steps of all frames, on rank 0
    std::int64_t recorded_before_ = -1;
    std::size_t n_described_ = 0; ///< number of frames in the XDMF file
};

} // namespace carrom

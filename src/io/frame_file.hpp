// SPDX-License-Identifier: BSD-3-Clause
// What this program's files hold, to be looked at by one rank, block by block: a checkpoint is a
// file of one frame.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/collision_log.hpp"

namespace carrom {

enum class FileKind { checkpoint, trajectory, collisions };

/// What a file shows of a disc, in the scene's units; 0 where the file does not have it.
struct FrameRow {
    double x = 0, y = 0, vx = 0, vy = 0;
    std::uint64_t wall_collisions = 0, pair_collisions = 0;
    double angular_velocity = 0;
};

struct FileSummary {
    FileKind kind = FileKind::checkpoint;
    std::string program_version;
    std::uint64_t n_discs = 0;        ///< 0 for a log of collisions
    double box_size = 0, radius = 0;  ///< radius: of a trajectory
    std::size_t bytes_per_number = 8; ///< of a trajectory's positions and velocities
    bool has_position = false, has_velocity = false, has_collisions = false,
         has_angular_velocity = false;
    std::vector<std::int64_t> steps;       ///< of the frames
    std::uint64_t n_logged = 0;            ///< collisions in a log
    std::string state_hash;                ///< of a checkpoint
    std::array<bool, 4> open_boundaries{}; ///< of a trajectory: left, right, bottom, top
    bool is_periodic_x = false,
         is_periodic_y = false; ///< of a trajectory: checkpoints leave it to the scene
};

/// All functions throw InputError naming the file. Not collective.
class FrameFile {
public:
    /// Damage that HDF5 does not see is not seen, and what it sees may be its end: `check_damage`
    /// comes first.
    explicit FrameFile(const std::string& path);
    ~FrameFile();
    FrameFile(FrameFile&&) noexcept;

    const FileSummary& summary() const { return summary_; }

    /// Checks every byte of a recording. Opening it checks all but its numbers.
    void check_numbers() const;

    /// Replaces `rows` by those of the discs [begin, end) in a frame.
    void read(std::size_t frame, std::uint64_t begin, std::uint64_t end,
              std::vector<FrameRow>& rows) const;

    /// Replaces `rows` by the collisions [begin, end) of a log.
    void read(std::uint64_t begin, std::uint64_t end, std::vector<LoggedCollision>& rows) const;

private:
    struct State;
    std::string path_;
    FileSummary summary_;
    std::unique_ptr<State> state_;
};

/// Where two files of one kind differ first, and by how much at most.
struct FileDifference {
    bool is_same = true;
    std::string first;  ///< "disc 17, vx: 0.25 and 0.5, step 10"
    double largest = 0; ///< of any number
    std::string largest_in;
};

FileDifference compare_files(const std::string& a, const std::string& b);

} // namespace carrom

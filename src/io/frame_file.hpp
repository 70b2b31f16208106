// SPDX-License-Identifier: BSD-3-Clause
// What this program's files hold, to be looked at by one rank, block by block: tables of numbers
// with a row for each disc of a frame, or for each collision. A checkpoint is a file of one frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/recorded_system.hpp"

namespace carrom {

enum class FileKind { checkpoint, trajectory, collisions };

/// Its box is that of the last frame.
struct FileSummary : RecordedSystem {
    FileKind kind = FileKind::checkpoint;
    /// Whether the file carries checksums of all its bytes, as all do that this program writes.
    bool has_checksums = false;
    /// The numbers of a row that the file has, in the scene's units. Of discs: x, y, vx, vy,
    /// pair_collisions, wall_collisions, then the columns beside the states (side_columns.hpp).
    std::vector<std::string> columns;
    std::uint64_t n_rows = 0;         ///< discs, or collisions
    std::size_t bytes_per_number = 8; ///< of a trajectory's positions and velocities
    std::vector<std::int64_t> steps;  ///< of the frames
    std::string state_hash;           ///< of a checkpoint
    std::vector<std::int64_t> gaps;   ///< of a log: first and last step of each stretch it lacks

    /// The place of a column, or that of the end where there is none.
    std::size_t place_of(std::string_view column) const;
    bool has(std::string_view column) const { return place_of(column) < columns.size(); }
};

/// Numbers by column, then by row.
using Rows = std::vector<std::vector<double>>;

/// All functions throw InputError naming the file. Not collective.
class FrameFile {
public:
    /// Damage that HDF5 does not see is not seen in checkpoints: `check_damage` comes first. A
    /// child process has opened the file before and read of all its parts (child_process.hpp).
    explicit FrameFile(const std::string& path);
    ~FrameFile();
    FrameFile(FrameFile&&) noexcept;

    const FileSummary& summary() const { return summary_; }

    /// Checks every byte of a recording. Opening it checks all but its numbers.
    void check_numbers() const;

    /// Replaces `rows` by [begin, end) of a frame's, or of a log's, whose only frame is 0.
    void read(std::size_t frame, std::uint64_t begin, std::uint64_t end, Rows& rows) const;

private:
    struct State;
    void open();
    void open_trajectory();
    void try_all_parts() const;
    void read_stored(std::size_t frame, std::uint64_t begin, std::uint64_t end, Rows& rows) const;
    void read_state(std::uint64_t begin, std::uint64_t end, Rows& rows) const;

    std::string path_;
    FileSummary summary_;
    std::unique_ptr<State> state_;
};

/// Where two files of one kind differ first, and by how much at most.
struct FileDifference {
    bool is_same = true;
    std::string first;  ///< "step 10, disc 17, vx: 0.25 and 0.5"
    double largest = 0; ///< of any number
    std::string largest_in;
};

FileDifference compare_files(const std::string& a, const std::string& b);

} // namespace carrom

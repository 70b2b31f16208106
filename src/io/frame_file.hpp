// SPDX-License-Identifier: BSD-3-Clause
// Reads Carrom's files on one rank, block by block: tables of numbers with a row for each disc of a
// frame, or for each collision. A checkpoint is a file of one frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/recorded_system.hpp"

namespace carrom {

enum class FileKind { checkpoint, trajectory, collisions };

/// The description of a file; its box is the box of the last frame.
struct FileSummary : RecordedSystem {
    FileKind kind = FileKind::checkpoint;
    /// Whether the file has checksums of all its bytes, as all files of this version do.
    bool has_checksums = false;
    /// The columns that the file has, in the scene's units. For discs: x, y, vx, vy, collisions
    /// with discs and walls, computed fields, images, then side columns (core/side_columns.hpp).
    std::vector<std::string> columns;
    std::uint64_t n_rows = 0;         ///< number of rows: discs, or collisions
    std::size_t bytes_per_number = 8; ///< bytes of each position and velocity
    std::vector<std::int64_t> steps;  ///< the steps of the frames
    std::vector<Box> boxes;           ///< the boxes of a trajectory's frames
    std::string state_hash;           ///< hash of a checkpoint; empty for other files
    std::vector<std::int64_t> gaps;   ///< the first and last step of each gap of a log

    /// The index of a column, or the number of columns if there is no such column.
    std::size_t place_of(std::string_view column) const;
    bool has(std::string_view column) const { return place_of(column) < columns.size(); }
};

/// Numbers, indexed by column, then by row.
using Rows = std::vector<std::vector<double>>;

/// All functions of this class throw an InputError that names the file. Not collective.
class FrameFile {
public:
    /// Call `check_damage` first for checkpoints, because HDF5 ignores some damage. A child process
    /// opens the file first, and reads from all its parts (child_process.hpp).
    explicit FrameFile(const std::string& path);
    ~FrameFile();
    FrameFile(FrameFile&&) noexcept;

    const FileSummary& summary() const { return summary_; }

    /// The paths of the segments of a recording.
    std::vector<std::string> segments() const;

    /// Checks every byte of a recording. The constructor checks all bytes except the numbers.
    void check_numbers() const;

    /// Replaces `rows` by the rows [begin, end) of a frame. A log has one frame, number 0.
    /// Positions are relative to the lower left corner of the box.
    void read(std::size_t frame, std::uint64_t begin, std::uint64_t end, Rows& rows) const;
    /// Like `read`, but with positions relative to the scene's origin.
    void read_shown(std::size_t frame, std::uint64_t begin, std::uint64_t end, Rows& rows) const;

    /// Returns the row numbers, ascending, of a frame's discs that have left the box through an
    /// open side. The frame must have velocities. It is read only if the box has an open side.
    std::vector<std::uint64_t> find_departed(std::size_t frame) const;

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

/// The first difference between two files of one kind, and the largest one.
struct FileDifference {
    bool is_same = true;
    std::string first;  ///< the first difference, such as "step 10, disc 17, vx: 0.25 and 0.5"
    double largest = 0; ///< the largest absolute difference of two numbers
    std::string largest_in;
};

FileDifference compare_files(const std::string& a, const std::string& b);

} // namespace carrom

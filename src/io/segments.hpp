// SPDX-License-Identifier: BSD-3-Clause
// The segments of a recording, the list of them in the file that joins them, and the checksums.
//
// The list gives each segment's rows, its room, the checksum of its rows, that of its structure,
// and where each column's numbers begin. So all of a segment is checked without HDF5, which may not
// survive what is damaged. The joining file ends with a mark and the XXH3-128 of all bytes before.
// Price of checking: all bytes are read once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/state_hash.hpp"
#include "io/files.hpp"
#include "io/hdf5.hpp"

namespace carrom {

/// Cells of a row that are written, hashed and read at a time.
inline constexpr std::uint64_t cells_per_part = std::uint64_t{1} << 16;

/// What is needed of a column to find and hash its numbers.
struct Width {
    std::uint64_t cells = 1, bytes_per_cell = 8;
    std::uint64_t bytes_per_row() const { return cells * bytes_per_cell; }
};

struct Segment {
    std::string name; ///< relative to the folder of the file that joins them
    std::uint64_t rows = 0, room = 0;
    StateHash numbers;                 ///< checksum of the rows that count
    StateHash structure;               ///< checksum of all bytes that are no numbers
    std::vector<std::uint64_t> places; ///< of the columns' first bytes
};

/// What the small file says of its segments.
struct Index {
    std::vector<Width> widths;
    std::vector<Segment> segments;
};

/// "trajectory/0001.h5" for "run/trajectory.h5" and 1.
std::string segment_name(const std::string& path, std::size_t number);

/// Checksums; a part of a row is hashed with its place.
StateHash hash_of_part(std::size_t column, std::uint64_t row, std::uint64_t begin,
                       std::span<const std::byte> bytes);
StateHash hash_of_rows(const Descriptor& file, const Segment& segment,
                       const std::vector<Width>& widths, std::uint64_t begin, std::uint64_t end);
StateHash hash_of_structure(const Descriptor& file, const Segment& segment,
                            const std::vector<Width>& widths);

/// Throws FileError, naming the segment, unless its structure is whole, and its rows where they are
/// wanted. `folder`: of the file that joins.
void check_segment(const std::string& folder, const Segment& segment,
                   const std::vector<Width>& widths, bool are_rows_wanted);

Index read_index(hid_t file, const std::string& path);
void write_index(hid_t file, const Index& index);

/// Appends the mark and the checksum to a file that joins segments, and brings it to disk.
void seal_index(const std::string& path);

/// Whether a file is one that joins segments, by its last bytes.
bool joins_segments(const std::string& path);

/// Checks such a file's own bytes and the structure of its segments; all their rows too where
/// `are_rows_wanted`. HDF5 gets nothing that has not been checked. Throws FileError.
void check_segments(const std::string& path, bool are_rows_wanted);

} // namespace carrom

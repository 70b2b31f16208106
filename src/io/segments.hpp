// SPDX-License-Identifier: BSD-3-Clause
// The segments of a recording, the list of them in the file that joins them, and the checksums.
//
// Segments are checked without HDF5, because HDF5 may crash or hang on a damaged segment. The
// joining file ends with a seal (seal.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/state_hash.hpp"
#include "io/checksums.hpp"
#include "io/hdf5.hpp"

namespace carrom {

struct FileSegment {
    std::string name; ///< path relative to the folder of the joining file
    std::uint64_t rows = 0, room = 0;
    StateHash numbers;                 ///< checksum of the valid rows
    StateHash structure;               ///< checksum of all bytes that are not numbers
    std::vector<std::uint64_t> places; ///< offset of each column in the segment
};

/// The list of segments in the file that joins them.
struct Index {
    std::vector<std::uint64_t> row_bytes; ///< bytes of a row for each column
    std::vector<FileSegment> segments;
};

/// The name of a segment: "trajectory/0001.h5" for "run/trajectory.h5" and 1.
std::string segment_name(const std::string& path, std::size_t number);
/// The path of a segment; `joining` is the path of the joining file.
std::string segment_path(const std::string& joining, const std::string& name);

/// The hashes so far of the columns of a segment; the sum of their digests is the segment's
/// checksum.
using ColumnHashers = std::vector<Hasher>;
ColumnHashers hashers_of_columns(std::size_t n_columns);
StateHash sum_of(const ColumnHashers& hashers);

/// Hashes the valid rows of a segment, column by column. Throws FileError.
ColumnHashers hash_rows(const std::string& path, const FileSegment& segment,
                        const std::vector<std::uint64_t>& row_bytes);
StateHash hash_of_structure(const std::string& path, const FileSegment& segment,
                            const std::vector<std::uint64_t>& row_bytes);

void write_index(hid_t file, const Index& index);

/// The index of a file that joins segments; nothing if its last bytes show that it is another kind
/// of file. Checks the file's own bytes and the structure of its segments, and also all their rows
/// if `are_rows_wanted`. Throws FileError, which names the segment.
std::optional<Index> read_checked_index(const std::string& path, bool are_rows_wanted);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Checksums over a whole file, kept in its first 4096 bytes, so that no flipped byte goes
// unnoticed: neither in the data nor in what HDF5 writes around it.
//
// HDF5 leaves the front of a file to its user ("user block"). There stand lines of text, then
// zeros: what the file is, its size, a checksum for each of its large data sets, one for all other
// bytes, and one for these lines. A data set's is the sum of the XXH3-128 of its blocks of rows,
// each seeded with its number. A sum has no order, so ranks and threads hash their shares side by
// side, the writer while it has the bytes at hand. Price of checking: the file is read once.
//
// Format 1, which is still read, has one checksum for the whole file, a sum over its megabytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/state_hash.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

inline constexpr std::uint64_t seal_size = 4096;

/// Where in a file the numbers of a data set stand, row after row, and their checksum.
struct SealedPart {
    std::string name;
    std::uint64_t begin = 0, rows = 0, bytes_per_row = 0;
    StateHash checksum;

    std::uint64_t end() const { return begin + rows * bytes_per_row; }
};

/// Rows that are hashed at a time; the last block of a data set may be shorter.
inline constexpr std::uint64_t rows_per_block = 1 << 10;

/// What one block adds to its data set's checksum.
StateHash checksum_of_block(std::span<const std::byte> bytes, std::uint64_t block);

/// Writes the seal of a file whose other bytes are final, and brings it to disk. `parts`: in the
/// order in which they stand in the file, with their checksums. Of one rank; throws FileError.
void seal(const std::string& path, const std::vector<SealedPart>& parts);

/// Whether a file begins like a sealed one, of any format, or has room for a seal before what HDF5
/// has written. Of one rank; throws FileError where it cannot be read.
bool is_sealed(const std::string& path);

/// The parts that a seal speaks of; none for format 1. Of one rank; throws FileError where there is
/// no whole seal.
std::vector<SealedPart> sealed_parts(const std::string& path);

/// Throws CollectiveError, code 2, on every rank unless the file is whole: sealed, of its size,
/// each byte as it was. Its text names the data sets that are not. **Collective.**
void check_seal(const std::string& path, const Communicator& communicator);

} // namespace carrom

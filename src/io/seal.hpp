// SPDX-License-Identifier: BSD-3-Clause
// A checksum over a whole file, kept in its first 4096 bytes, so that no flipped byte goes unnoticed: neither in the data
// nor in what HDF5 writes around it.
//
// HDF5 leaves the front of a file to its user ("user block"). There stand three lines of text, then zeros: what the file
// is, its size, and the sum of the XXH3-128 of all its further megabytes, each seeded with its number. A sum has no
// order, so ranks hash shares of the file side by side. Price: the file is read once, from memory where it was just
// written.
#pragma once

#include <cstdint>
#include <string>

#include "carrom/parallel/communicator.hpp"

namespace carrom {

inline constexpr std::uint64_t seal_size = 4096;

/// Writes the seal of a file whose other bytes are final, and brings it to disk. If that fails every rank throws
/// CollectiveError, code 4. **Collective.**
void seal(const std::string& path, const Communicator& communicator);

/// Whether a file begins like a sealed one, of any format, or has room for a seal before what HDF5 has written. Of one rank; throws FileError where it cannot be read.
bool is_sealed(const std::string& path);

/// Throws CollectiveError, code 2, on every rank unless the file is whole: sealed, of its size, each byte as it was.
/// **Collective.**
void check_seal(const std::string& path, const Communicator& communicator);

} // namespace carrom

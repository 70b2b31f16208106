// SPDX-License-Identifier: BSD-3-Clause
// Checks the bytes of a small HDF5 file before HDF5 reads them, because HDF5 may hang on damage.
//
// A file that joins segments ends with a seal: a mark and the XXH3-128 of all bytes before the
// checksum. So any damage is found in milliseconds. If the seal itself is damaged, or another
// program has written the file, `check_heaps` detects the one kind of damage on which HDF5 is known
// to loop for ever.
#pragma once

#include <optional>
#include <string>

#include "core/state_hash.hpp"

namespace carrom {

/// Appends the mark and the checksum to a file that joins segments, and syncs it to disk.
void seal_index(const std::string& path);

/// Returns the checksum at the end of a file that joins segments, without testing it; nothing for
/// other files.
std::optional<StateHash> seal_of(const std::string& path);

/// Returns whether the file ends with a seal. Throws FileError if the checksum of the seal
/// is wrong.
bool check_seal(const std::string& path);

/// Throws FileError if a global heap of HDF5, which contains the names of segments, has an object
/// without a size, because HDF5 up to 2.0 never finishes reading such an object. Files above 16 MiB
/// are not searched, because Carrom's files with such heaps are smaller.
void check_heaps(const std::string& path);

} // namespace carrom

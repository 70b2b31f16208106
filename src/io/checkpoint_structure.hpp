// SPDX-License-Identifier: BSD-3-Clause
// Creates a checkpoint's HDF5 file with its whole structure, but without the discs' numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/disc_state.hpp"
#include "core/state_hash.hpp"
#include "dynamics/species.hpp"
#include "io/checkpoint.hpp"
#include "io/checksums.hpp"

namespace carrom {

/// A data set with one row for each disc, and the function that converts discs to its bytes.
struct DiscTarget {
    std::string path;
    hid_t type; ///< type of the numbers
    std::uint64_t bytes_per_row = 0;
    std::string unit; ///< unit, for other programs; empty if only Carrom reads this data set
    std::function<void(std::span<const DiscState>, std::byte*)> put;
};

/// Side columns (core/side_columns.hpp) of the discs in this rank's pieces, in order of id.
struct SideOfPieces {
    DiscId first = 0;
    SideColumns columns;

    double of(SideColumn column, const DiscState& disc) const {
        return columns[column][disc.id - first];
    }
};

/// The data sets of discs in a checkpoint. `samples` and `columns` must outlive the result.
std::vector<DiscTarget> disc_targets(const CheckpointHeader& header, const StoredSamples& samples,
                                     const SideOfPieces& columns);

/// Sums that are complete only after all discs have been added. Each is a pair of words; threads
/// and ranks may add to them in any order. The first sum counts collisions of discs with walls
/// (`low`) and with discs (`high`; a collision of a pair counts twice). Then come the state's hash
/// and the checksums.
using StateSums = std::vector<StateHash>;
inline constexpr std::size_t place_of_collisions = 0, place_of_hash = 1, first_checksum = 2;

/// Makes the file. The header's counters and hash, and all checksums, are written later by
/// `complete`. Called on one rank; throws FileError.
void create_structure(const std::string& path, CheckpointHeader header,
                      const StoredSamples& samples, const std::vector<DiscTarget>& targets);

/// Writes the counters, the hash and the checksums, and last the checksum of all other bytes. Then
/// syncs the file to disk. Called on one rank; throws FileError.
void complete(const std::string& path, const StateSums& sums);

} // namespace carrom

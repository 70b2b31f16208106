// SPDX-License-Identifier: BSD-3-Clause
// A checkpoint's HDF5 file with all its structure and none of its numbers, and where those belong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/disc.hpp"
#include "core/state_hash.hpp"
#include "io/checkpoint.hpp"
#include "io/seal.hpp"

namespace carrom {

/// A data set with one row for each disc, and how discs become its bytes. Its part's `begin` is
/// known once the file is there.
struct DiscTarget {
    SealedPart part;
    std::function<void(std::span<const Disc>, std::byte*)> put;
};

/// Of this rank's pieces (pieces.hpp), in the order of ids; empty where discs do not turn.
struct SpinsOfPieces {
    DiscId first = 0;
    std::vector<double> values;

    double of(const Disc& disc) const { return values[disc.id - first]; }
};

/// The data sets of discs that a checkpoint has, in the order in which they stand in the file.
/// `samples` and `spins` must outlive them.
std::vector<DiscTarget> disc_targets(const CheckpointHeader& header, const StoredSamples& samples,
                                     const SpinsOfPieces& spins);

/// What is known of a state only once all its discs have been seen.
struct StateSums {
    std::uint64_t wall_collisions = 0, pair_collisions = 0; ///< of discs: a pair counts twice
    StateHash hash;
};

/// Where single values of /carrom/run stand in the file.
struct HeaderPlaces {
    std::uint64_t wall_collisions = 0, pair_collisions = 0, state_hash = 0;
};

/// Makes the file and fills in where each target's rows begin. The header's counters and hash stay
/// open. Of one rank; throws FileError.
HeaderPlaces create_structure(const std::string& path, CheckpointHeader header,
                              const StoredSamples& samples, std::vector<DiscTarget>& targets);

/// Writes the values that were left open. Of one rank; throws FileError.
void fill_in(const std::string& path, const HeaderPlaces& places, const StateSums& sums);

} // namespace carrom

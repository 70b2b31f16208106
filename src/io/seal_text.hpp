// SPDX-License-Identifier: BSD-3-Clause
// The text of a seal. What is parsed is exactly what was written: each seal has one text, and its
// last line hashes the others.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "io/seal.hpp"

namespace carrom {

inline constexpr std::string_view seal_family = "carrom checkpoint, format ";

using SealBlock = std::array<char, seal_size>;

struct Seal {
    int format = 2;
    std::uint64_t size = 0;        ///< of the file
    StateHash rest;                ///< checksum of what is in no part; in format 1 of all
    std::vector<SealedPart> parts; ///< in the order in which they stand in the file
};

/// The front of a file of format 2.
SealBlock block_of(const Seal& seal);

/// The size that a seal of any format we read speaks of; throws FileError where there is no such
/// seal.
std::uint64_t sealed_size(const SealBlock& block);

/// Throws FileError unless the block is one that a writer has made; its parts follow each other
/// within the file then.
Seal parsed(const SealBlock& block);

} // namespace carrom

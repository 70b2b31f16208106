// SPDX-License-Identifier: BSD-3-Clause
#include "core/state_hash.hpp"

#include <array>
#include <bit>
#include <cstdio>

#include <xxhash.h>

#include "core/disc_columns.hpp"

namespace carrom {

static_assert(std::endian::native == std::endian::little, "the hashed record is little-endian");

StateHash hash_of(const DiscState& disc) {
    // Adding +0 turns -0 into +0 and changes no other number.
    const std::array<std::uint64_t, 8> record = {
        disc.id,
        std::bit_cast<std::uint64_t>(disc.x + 0.0),
        std::bit_cast<std::uint64_t>(disc.y + 0.0),
        std::bit_cast<std::uint64_t>(disc.vx + 0.0),
        std::bit_cast<std::uint64_t>(disc.vy + 0.0),
        std::bit_cast<std::uint64_t>(columns::stored_time(disc) + 0.0),
        disc.wall_collisions,
        disc.pair_collisions};
    const XXH128_hash_t hash = XXH3_128bits(record.data(), sizeof record);
    return {hash.low64, hash.high64};
}

StateHash hash_of(std::span<const DiscState> discs) {
    StateHash sum;
    for (const DiscState& disc : discs) sum += hash_of(disc);
    return sum;
}

/// The seed of the hash is the index of the column. Spin has index 0, which means no seed.
StateHash hash_of(SideColumn column, DiscId id, double number) {
    const std::array<std::uint64_t, 2> record = {id, std::bit_cast<std::uint64_t>(number + 0.0)};
    const XXH128_hash_t hash = XXH3_128bits_withSeed(record.data(), sizeof record,
                                                     static_cast<std::uint64_t>(column));
    return {hash.low64, hash.high64};
}

std::string to_string(const StateHash& hash) {
    std::array<char, 33> text{};
    std::snprintf(text.data(), text.size(), "%016llx%016llx",
                  static_cast<unsigned long long>(hash.high),
                  static_cast<unsigned long long>(hash.low));
    return text.data();
}

} // namespace carrom

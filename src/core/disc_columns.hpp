// SPDX-License-Identifier: BSD-3-Clause
// A disc's stored numbers by name, for files that store each number as a column.
//
// The table `disc_columns` has a line for each number of the 64-byte state, except the id and the
// image. The flags `is_departed` and `has_collided` are encoded in the column of the time `tau`.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/disc_state.hpp"

namespace carrom {

/// A column with one number of 8 bytes for each disc: either all are doubles, or all are integers.
struct StateColumn {
    const char* name;
    const char* unit;
    bool is_real;
    /// Writes this number of each of the `discs` to `out`, without gaps.
    void (*put)(std::span<const DiscState> discs, std::byte* out);
    void (*set)(DiscState& disc, std::uint64_t bits);
};

namespace columns {

/// Makes a column; `Get(disc)` returns the number and `Set(disc, bits)` stores it.
template <auto Get, auto Set>
constexpr StateColumn make(const char* name, const char* unit, bool is_real) {
    return {name, unit, is_real,
            [](std::span<const DiscState> discs, std::byte* out) {
                for (const DiscState& disc : discs) {
                    const auto number = Get(disc);
                    static_assert(sizeof number == 8);
                    std::memcpy(out, &number, 8);
                    out += 8;
                }
            },
            [](DiscState& disc, std::uint64_t bits) { Set(disc, bits); }};
}
template <auto Field> constexpr StateColumn make(const char* name, const char* unit) {
    return make<[](const DiscState& disc) { return disc.*Field; },
                [](DiscState& disc, std::uint64_t bits) {
                    disc.*Field = std::bit_cast<double>(bits);
                }>(name, unit, true);
}

inline constexpr std::uint64_t all_of_counter = 0x7fffffffffff;

/// The stored value of `tau` for a departed disc.
inline constexpr double departed_time = -1;
/// The stored value of `tau` for a disc that collided exactly at a sync.
inline constexpr double collided_at_sync = -0.0;
inline double stored_time(const DiscState& disc) {
    if (disc.has_departed()) return departed_time;
    return disc.has_collided && disc.tau == 0 ? collided_at_sync : disc.tau;
}
inline void set_stored_time(DiscState& disc, std::uint64_t bits) {
    const auto time = std::bit_cast<double>(bits);
    disc.is_departed = time == departed_time;
    disc.tau = disc.has_departed() || time == 0 ? 0 : time;
    disc.has_collided = !disc.has_departed() && (time > 0 || std::signbit(time));
}

} // namespace columns

inline constexpr std::array disc_columns = {
    columns::make<&DiscState::x>("x", "length"),
    columns::make<&DiscState::y>("y", "length"),
    columns::make<&DiscState::vx>("vx", "length per micro-step"),
    columns::make<&DiscState::vy>("vy", "length per micro-step"),
    columns::make<&columns::stored_time, &columns::set_stored_time>("tau", "micro-steps", true),
    columns::make<[](const DiscState& disc) { return std::uint64_t{disc.wall_collisions}; },
                  [](DiscState& disc, std::uint64_t bits) {
                      disc.wall_collisions = bits & columns::all_of_counter;
                  }>("wall_collisions", "1", false),
    columns::make<[](const DiscState& disc) { return std::uint64_t{disc.pair_collisions}; },
                  [](DiscState& disc, std::uint64_t bits) {
                      disc.pair_collisions = bits & columns::all_of_counter;
                  }>("pair_collisions", "1", false)};

} // namespace carrom

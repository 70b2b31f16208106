// SPDX-License-Identifier: BSD-3-Clause
// A disc's stored numbers by name, for files that keep them column by column.
//
// A new number in the 64-byte state is one more line here. Image counts are not
// stored, so they have no column.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/disc.hpp"

namespace carrom {

/// One number of 8 bytes for each disc: a double, or else a whole number.
struct StateColumn {
    const char* name;
    const char* unit;
    bool is_real;
    /// Writes the numbers of all discs, one after the other.
    void (*put)(std::span<const Disc> discs, std::byte* out);
    void (*set)(Disc& disc, std::uint64_t bits);
};

namespace columns {

/// `Get(disc)` is the number, `Set(disc, bits)` takes it over.
template <auto Get, auto Set>
constexpr StateColumn make(const char* name, const char* unit, bool is_real) {
    return {name, unit, is_real,
            [](std::span<const Disc> discs, std::byte* out) {
                for (const Disc& disc : discs) {
                    const auto number = Get(disc);
                    static_assert(sizeof number == 8);
                    std::memcpy(out, &number, 8);
                    out += 8;
                }
            },
            [](Disc& disc, std::uint64_t bits) { Set(disc, bits); }};
}
template <auto Field> constexpr StateColumn make(const char* name, const char* unit) {
    return make<[](const Disc& disc) { return disc.*Field; },
                [](Disc& disc, std::uint64_t bits) { disc.*Field = std::bit_cast<double>(bits); }>(
        name, unit, true);
}

inline constexpr std::uint64_t all_of_counter = 0x7fffffffffff;

/// Stands for the time of a departed disc, which has none.
inline constexpr double departed_time = -1;
/// A resting disc has -2 less its time, which is a whole number at the end of a step.
inline double stored_time(const Disc& disc) {
    if (disc.rests()) return -2 - disc.tau;
    return disc.has_departed() ? departed_time : disc.tau;
}
inline void set_stored_time(Disc& disc, std::uint64_t bits) {
    disc.tau = std::bit_cast<double>(bits);
    disc.is_departed = disc.tau == departed_time;
    disc.is_resting = disc.tau <= -2;
    if (disc.has_departed()) disc.tau = 0;
    if (disc.rests()) disc.tau = -2 - disc.tau;
}

} // namespace columns

inline constexpr std::array disc_columns = {
    columns::make<&Disc::x>("x", "length"),
    columns::make<&Disc::y>("y", "length"),
    columns::make<&Disc::vx>("vx", "length per micro-step"),
    columns::make<&Disc::vy>("vy", "length per micro-step"),
    columns::make<&columns::stored_time, &columns::set_stored_time>("tau", "micro-steps", true),
    columns::make<[](const Disc& disc) { return std::uint64_t{disc.wall_collisions}; },
                  [](Disc& disc, std::uint64_t bits) {
                      disc.wall_collisions = bits & columns::all_of_counter;
                  }>("wall_collisions", "1", false),
    columns::make<[](const Disc& disc) { return std::uint64_t{disc.pair_collisions}; },
                  [](Disc& disc, std::uint64_t bits) {
                      disc.pair_collisions = bits & columns::all_of_counter;
                  }>("pair_collisions", "1", false)};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Random numbers by counter. Any rank can draw any disc's numbers, in any order, and gets the same
// ones.
//
// Philox4x64-10 (Salmon, Moraes, Dror and Shaw, SC 2011) with key (seed, purpose) and counter (id,
// attempt, ...), so two purposes never use the same number. The words are turned into numbers with
// + - * / and sqrt only, which have the same bits on every machine.
#pragma once

#include <array>
#include <cstdint>

#include "core/disc_state.hpp"

namespace carrom {

/// The purposes of numbers. The values are part of the promise that a seed always
/// gives the same discs.
enum class Purpose : std::uint64_t {
    position = 1,
    shake = 2,
    velocity = 3,
    thermal_wall = 4,
    sync = 5,
    direction = 6,
    swap = 7,
    inlet = 8
};

/// Four random words for this counter.
std::array<std::uint64_t, 4> random_words(std::uint64_t seed, Purpose purpose, DiscId id,
                                          std::uint64_t attempt, std::uint64_t block = 0);

/// The top 53 bits of a word as a number in [0, 1).
inline double unit_number(std::uint64_t word) { return static_cast<double>(word >> 11) * 0x1p-53; }

/// One disc's endless sequence of numbers for one purpose.
class DiscRandom {
public:
    /// Each `occasion` gives another sequence for the same disc.
    DiscRandom(std::uint64_t seed, Purpose purpose, DiscId id, std::uint64_t occasion = 0)
        : seed_(seed), purpose_(purpose), id_(id), occasion_(occasion) {}

    double uniform(); ///< in [0, 1)

private:
    std::uint64_t seed_;
    Purpose purpose_;
    DiscId id_;
    std::uint64_t occasion_;
    std::uint64_t block_ = 0;
    unsigned used_ = 4;
    std::array<std::uint64_t, 4> words_{};
};

/// A direction: uniform in the unit disc by rejection, then scaled to length 1 (Marsaglia 1972; no
/// sine, no cosine).
struct Direction {
    double x = 0, y = 0;
};
Direction random_direction(DiscRandom& random);

/// A number from the exponential distribution of mean 1, by von Neumann's comparisons (J. von
/// Neumann, Various techniques used in connection with random digits, 1951; G. E. Forsythe, Math.
/// Comp. 26, 1972): no logarithm.
double random_exponential(DiscRandom& random);

/// Two independent numbers from the normal distribution of mean 0 and variance 1: half the square
/// of their distance from 0 is exponential, and the direction is uniform.
struct NormalPair {
    double x = 0, y = 0;
};
NormalPair random_normals(DiscRandom& random);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Random numbers from counters. Any rank can draw the numbers of any disc in any order, and gets
// the same numbers.
//
// The generator is Philox4x64-10 (Salmon, Moraes, Dror and Shaw, SC 2011) with the key (seed,
// purpose) and the counter (id, attempt, ...), so numbers for two purposes are independent. Random
// words are converted to numbers with + - * / and sqrt only, which give the same bits on every
// machine.
#pragma once

#include <array>
#include <cstdint>

#include "core/disc_state.hpp"

namespace carrom {

/// The uses of random numbers. Never change a value, because a seed must always give the same
/// numbers.
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

/// Four random 64-bit words. Equal arguments always give equal words.
std::array<std::uint64_t, 4> random_words(std::uint64_t seed, Purpose purpose, DiscId id,
                                          std::uint64_t attempt, std::uint64_t block = 0);

/// The top 53 bits of a word as a number in [0, 1).
inline double unit_number(std::uint64_t word) { return static_cast<double>(word >> 11) * 0x1p-53; }

/// One disc's endless sequence of numbers for one purpose.
class DiscRandom {
public:
    /// `occasion` selects one of many independent sequences of the same disc.
    DiscRandom(std::uint64_t seed, Purpose purpose, DiscId id, std::uint64_t occasion = 0)
        : seed_(seed), purpose_(purpose), id_(id), occasion_(occasion) {}

    double uniform(); ///< uniform in [0, 1)

private:
    std::uint64_t seed_;
    Purpose purpose_;
    DiscId id_;
    std::uint64_t occasion_;
    std::uint64_t block_ = 0;
    unsigned used_ = 4;
    std::array<std::uint64_t, 4> words_{};
};

/// A unit vector. `random_direction` draws a point uniformly in the unit disc by rejection and
/// scales it to length 1, which needs no sine or cosine (Marsaglia 1972).
struct Direction {
    double x = 0, y = 0;
};
Direction random_direction(DiscRandom& random);

/// A number from the exponential distribution of mean 1, without a logarithm, by von Neumann's
/// comparisons (J. von Neumann, Various techniques used in connection with random digits, 1951; G.
/// E. Forsythe, Math. Comp. 26, 1972).
double random_exponential(DiscRandom& random);

/// Two independent numbers from the normal distribution of mean 0 and variance 1. Half of x^2 + y^2
/// is exponentially distributed, and the direction of (x, y) is uniform.
struct NormalPair {
    double x = 0, y = 0;
};
NormalPair random_normals(DiscRandom& random);

} // namespace carrom

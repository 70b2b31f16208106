// SPDX-License-Identifier: BSD-3-Clause
// The discs of the legacy generator, number for number: C `rand`, seeded; all positions first, x
// then y, uniform in [r, L-r] and drawn anew on overlap; then for each disc its speed, uniform in
// L/8r .. L/4, and its angle.
//
// The sequence is that of glibc's rand (its reentrant random_r with 128 bytes of
// state); sine and cosine are the C library's, here and nowhere else in a scene. One
// rank draws, because each number depends on those before. A grid makes a draw O(1).
#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "lattices/lattice.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// glibc's `rand` with its own state.
class LegacyRandom {
public:
    explicit LegacyRandom(unsigned seed);
    LegacyRandom(const LegacyRandom&) = delete;
    LegacyRandom& operator=(const LegacyRandom&) = delete;

    /// low + (high - low) * rand() / RAND_MAX; both ends can occur.
    double uniform(double low, double high);

private:
    char state_[128] = {};
    random_data data_{};
};

/// All positions by id; nothing if the box is so full that a bounded number of draws does not find
/// them.
std::optional<std::vector<Point>> legacy_positions(const SceneParameters& scene,
                                                   LegacyRandom& random);

/// The next disc's velocity per step. Call it in the order of ids, after `positions`.
InputDisc legacy_disc(const SceneParameters& scene, LegacyRandom& random, DiscId id, Point place);

} // namespace carrom

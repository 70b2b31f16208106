// SPDX-License-Identifier: BSD-3-Clause
// The discs of the legacy generator, with exactly the same numbers as in the course program. It
// draws with C's `rand` from a seed. All positions come first, x before y, uniform in [r, L-r], and
// are drawn again if discs overlap. Then each disc gets its speed, uniform in L/8r .. L/4, and its
// angle.
//
// `rand` is that of glibc (its reentrant random_r with 128 bytes of state). Sine and cosine are
// those of the C library, which nothing else in a scene uses. One rank draws, because each number
// depends on those before. A grid makes a draw O(1).
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

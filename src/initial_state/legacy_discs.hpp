// SPDX-License-Identifier: BSD-3-Clause
// The discs of the legacy generator, with exactly the same numbers as in the course program. For
// radius r and box edge L, it first draws all positions by C's `rand`, x before y, uniform in
// [r, L-r], and repeats a draw if discs overlap. Then each disc gets its speed per step, uniform in
// [L/(8r), L/4], and its angle.
//
// `rand` is glibc's function (its reentrant random_r with 128 bytes of state). Sine and cosine are
// rounded correctly (core/rounded_sine.hpp), not by the C library. One rank draws, because each
// number depends on the numbers before. With a grid of cells, the time of a draw is O(1).
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

    /// low + (high - low) * rand() / RAND_MAX; both `low` and `high` are possible results.
    double uniform(double low, double high);

private:
    char state_[128] = {};
    random_data data_{};
};

/// Positions of all discs in order of id; nothing if the box is so full that a bounded number of
/// draws is not enough.
std::optional<std::vector<Point>> legacy_positions(const SceneParameters& scene,
                                                   LegacyRandom& random);

/// Disc `id` at `place`. Draws its velocity (lengths per step) from `random`, so call it in order
/// of id.
InputDisc legacy_disc(const SceneParameters& scene, LegacyRandom& random, DiscId id, Point place);

} // namespace carrom

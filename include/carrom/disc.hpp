// SPDX-License-Identifier: BSD-3-Clause
// The state of a disc, as users of the library read and set it.
#pragma once

#include <cstdint>

namespace carrom {

/// Lengths are in the scene's unit, times in steps.
struct Disc {
    std::uint64_t id = 0;              ///< 0 to N - 1
    double x = 0, y = 0;               ///< position of the centre; SceneFacts has the box's corner
    double vx = 0, vy = 0;             ///< velocity, length per step
    double spin = 0;                   ///< radians per step, counterclockwise; 0 for smooth discs
    std::uint64_t wall_collisions = 0; ///< collisions with walls since the scene's start
    std::uint64_t pair_collisions = 0; ///< collisions with other discs since the scene's start

    friend bool operator==(const Disc&, const Disc&) = default;
};

/// Properties of a disc besides its state. For growing discs `radius` is the radius at the scene's
/// start.
struct DiscKind {
    double radius = 0;        ///< radius, in the scene's unit
    double mass = 1;          ///< mass in the scene's unit
    std::int64_t species = 0; ///< index of the species, from 0, in order of id

    friend bool operator==(const DiscKind&, const DiscKind&) = default;
};

} // namespace carrom

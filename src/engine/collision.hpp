// SPDX-License-Identifier: BSD-3-Clause
// What an engine reports of single events: collisions, and crossings of periodic sides.
#pragma once

#include <cstdint>

#include "core/disc_state.hpp"

namespace carrom {

/// A collision that has happened. Order: micro_step, time, generation, p, wall before pair, q.
struct Collision {
    static constexpr DiscId wall = ~DiscId{0};

    std::int64_t micro_step = 0;  ///< `time` counts from it; since the scene's start
    double time = 0;              ///< in micro-steps
    std::uint64_t generation = 0; ///< orders chains that take no time in the event-driven method
    DiscId p = 0, q = wall;       ///< p is the lower id of a pair
    double impulse = 0;           ///< that p has got, in mass times length per step
};

/// A disc that has flown on through periodic sides has been brought back into the box
/// by this many box lengths.
struct Crossing {
    DiscId disc = 0;
    double x = 0, y = 0; ///< whole numbers
};

} // namespace carrom

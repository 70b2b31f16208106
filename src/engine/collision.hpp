// SPDX-License-Identifier: BSD-3-Clause
// The data of single events that an engine reports: collisions and crossings of periodic sides.
#pragma once

#include <cstdint>

#include "core/disc_state.hpp"

namespace carrom {

/// A collision. Collisions are ordered by micro_step, time, generation, p, wall before pair, q.
struct Collision {
    static constexpr DiscId wall = ~DiscId{0};

    /// `time` counts from the start of this micro-step; the scene's first micro-step is number 0
    std::int64_t micro_step = 0;
    double time = 0; ///< time in micro-steps
    /// Position in a chain of collisions at the same time; always 0 in the time-stepped method
    std::uint64_t generation = 0;
    DiscId p = 0, q = wall; ///< p is the lower id of a pair
    double impulse = 0;     ///< magnitude of the impulse on p, in mass times length per step
};

/// The numbers of box lengths that a sync subtracts from the coordinates of a disc to bring it back
/// into a periodic box.
struct Crossing {
    DiscId disc = 0;
    double x = 0, y = 0; ///< whole numbers of box lengths
};

} // namespace carrom

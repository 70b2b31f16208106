// SPDX-License-Identifier: BSD-3-Clause
// A disc's stored state: where it was at its own time `tau`, and how often it has collided.
//
// The state is rewritten by the disc's own collisions and stops and by the common sync, and by
// nothing else (docs/method.md, section 2). It fills one cache line: the engine reaches states at
// random, one disc at a time.
#pragma once

#include <cstdint>

namespace carrom {

/// A disc's global number, 0 .. N-1. It breaks every tie in the total order.
using DiscId = std::uint64_t;

/// A disc's place in one rank's arrays. Never compared between ranks, never part of an order.
using LocalIndex = std::uint32_t;

/// Lengths are in the scene's unit; velocities in lengths per micro-step; `tau` in micro-steps
/// since the last sync.
struct alignas(64) Disc {
    double x = 0, y = 0;
    double vx = 0, vy = 0;
    double tau = 0;
    DiscId id = 0;
    std::uint64_t wall_collisions = 0;
    std::uint64_t pair_collisions = 0;

    /// Has left the box at (x, y) through an open side: at rest there, it takes part in nothing any
    /// more. No other state has such a time.
    static constexpr double departed = -1;
    bool has_departed() const { return tau < 0; }

    double x_at(double time) const { return x + vx * (time - tau); }
    double y_at(double time) const { return y + vy * (time - tau); }

    /// Changes whenever the state is rewritten within a sync interval: every rewrite comes with a
    /// collision.
    std::uint32_t version() const {
        return static_cast<std::uint32_t>(wall_collisions + pair_collisions);
    }
};
static_assert(sizeof(Disc) == 64);

} // namespace carrom

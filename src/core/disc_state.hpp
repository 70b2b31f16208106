// SPDX-License-Identifier: BSD-3-Clause
// A disc's stored state: its position at its own time `tau`, and how often it has collided.
//
// Only the disc's own collisions and stops and the common sync rewrite the state
// (docs/understanding/method.md, section 2). It fills one cache line, because the engine reads the
// states of single discs at random places.
#pragma once

#include <cstdint>

#include "core/device.hpp"
#include "core/raw_vector.hpp"

#ifdef __FAST_MATH__
#error "-ffast-math changes results from one compiler to the next; build Carrom without it"
#endif

namespace carrom {

/// A disc's global number, 0 .. N-1. It breaks every tie in the total order.
using DiscId = std::uint64_t;

/// A disc's place in one rank's arrays. Never compared between ranks, never part of an order.
using LocalIndex = std::uint32_t;

/// Lengths are in the scene's unit, velocities in lengths per micro-step, `tau` in micro-steps
/// since the last sync. Counters have 47 bits: a disc that collides a million times a second
/// reaches their end after four years.
struct alignas(64) DiscState {
    double x = 0, y = 0;
    double vx = 0, vy = 0;
    double tau = 0;
    DiscId id = 0;
    std::uint64_t wall_collisions : 47 = 0;
    std::uint64_t is_departed : 1 = 0; ///< set by depart()
    std::int64_t image_x : 16 = 0; ///< the disc's image is this many box lengths away (image.hpp)
    std::uint64_t pair_collisions : 47 = 0;
    /// Whether the disc has collided since the last sync; only used if collisions may take energy
    std::uint64_t has_collided : 1 = 0;
    std::int64_t image_y : 16 = 0;

    /// The disc has left the box at (x, y) through an open side. It stays at rest there and takes
    /// no further part in the simulation.
    void depart() {
        vx = vy = tau = 0;
        is_departed = 1;
    }
    CARROM_DEVICE bool has_departed() const { return is_departed != 0; }

    CARROM_DEVICE double x_at(double time) const { return x + vx * (time - tau); }
    CARROM_DEVICE double y_at(double time) const { return y + vy * (time - tau); }

    /// Changes whenever the state is rewritten within a sync interval: every rewrite comes with a
    /// collision.
    CARROM_DEVICE std::uint32_t version() const {
        return static_cast<std::uint32_t>(wall_collisions + pair_collisions);
    }
};
static_assert(sizeof(DiscState) == 64);

/// Many states. Resizing does not initialise the new elements: the caller writes each of them, or
/// passes a value.
using DiscStates = RawVector<DiscState>;

CARROM_DEVICE inline double squared_speed_of(const DiscState& disc) {
    return disc.vx * disc.vx + disc.vy * disc.vy;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// A disc's stored state: its position at its own time `tau`, its velocity and collision counts.
//
// A state changes only if its disc collides or stops, and at syncs of all discs
// (docs/understanding/method.md, section 2). A state fills one cache line, because the engine reads
// states of single discs at random places in memory.
#pragma once

#include <cstdint>

#include "core/device.hpp"
#include "core/raw_vector.hpp"

#ifdef __FAST_MATH__
#error "-ffast-math changes results from one compiler to the next; build Carrom without it"
#endif

namespace carrom {

/// A disc's global number, 0 .. N-1. Events at equal times are ordered by these numbers.
using DiscId = std::uint64_t;

/// A disc's index in the arrays of one rank. It must not affect the order of events.
using LocalIndex = std::uint32_t;

/// Lengths are in the scene's unit, velocities in lengths per micro-step, `tau` in micro-steps
/// since the last sync. Counters have 47 bits, which is enough for a disc that collides a million
/// times a second for four years.
struct alignas(64) DiscState {
    double x = 0, y = 0;
    double vx = 0, vy = 0;
    double tau = 0;
    DiscId id = 0;
    std::uint64_t wall_collisions : 47 = 0;
    std::uint64_t is_departed : 1 = 0; ///< set by depart(), cleared when the disc comes back
    std::int64_t image_x : 16 = 0;     ///< the image's displacement along x, in boxes (image.hpp)
    std::uint64_t pair_collisions : 47 = 0;
    /// Whether the disc has collided since the last sync; set only in runs with effects
    std::uint64_t has_collided : 1 = 0;
    std::int64_t image_y : 16 = 0;

    /// Marks the disc as departed: it has left the box at (x, y) through an open side, stays at
    /// rest there, and takes no part in the simulation unless an inlet brings it back.
    void depart() {
        vx = vy = tau = 0;
        is_departed = 1;
    }
    CARROM_DEVICE bool has_departed() const { return is_departed != 0; }

    CARROM_DEVICE double x_at(double time) const { return x + vx * (time - tau); }
    CARROM_DEVICE double y_at(double time) const { return y + vy * (time - tau); }

    /// A number that changes whenever the state changes within a sync interval, because each such
    /// change is a collision and increases a counter.
    CARROM_DEVICE std::uint32_t version() const {
        return static_cast<std::uint32_t>(wall_collisions + pair_collisions);
    }
};
static_assert(sizeof(DiscState) == 64);

/// A vector of states. Resizing does not initialise new elements, so the caller must write each of
/// them, or pass a value to `resize`.
using DiscStates = RawVector<DiscState>;

CARROM_DEVICE inline double squared_speed_of(const DiscState& disc) {
    return disc.vx * disc.vx + disc.vy * disc.vy;
}

} // namespace carrom

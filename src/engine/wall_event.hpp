// SPDX-License-Identifier: BSD-3-Clause
// A collision of a disc with a side of the box or a fixed body, and the impulse and energy that the
// disc gained. Engines record it only if a measurement follows walls. For lasting contacts a sync
// records one event for all discs that press on a side or a body.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/disc_state.hpp"
#include "core/frame.hpp"
#include "dynamics/fixed_bodies.hpp"
#include "engine/followers.hpp"

namespace carrom {

/// Steps are the unit of time, and all numbers are in the box's own frame. Sides are numbered as in
/// `boundary_names`.
struct WallEvent {
    std::uint8_t side = 0;
    double normal = 0; ///< impulse on the disc normal to the side, positive away from it
    double along = 0;  ///< impulse on the disc along the side, in the direction of the axis
    double energy = 0; ///< energy of translation that the disc has gained
    /// Whether this is not a collision but a lasting contact, with its impulse until the next sync
    bool is_lasting = false;
    // For a fixed body, which has no side:
    std::uint32_t body = no_body; ///< number of the body's row in rows_of (dynamics/container.hpp)
    double ix = 0, iy = 0;        ///< impulse on the disc
    double torque = 0;            ///< angular momentum that the body gains, about its centre

    static constexpr std::uint32_t no_body = 0xffffffff;
    bool is_at_side() const { return body == no_body; }
};
using WallFollower = EventFollower<WallEvent>;

/// The event of a collision with a fixed body; see `wall_event` for the arguments.
inline WallEvent body_event(const Frame& frame, const BodyTouch& touch, double mass,
                            const DiscState& after, double dx, double dy, double unit) {
    const double per_step = frame.slowing * unit, gained_x = dx * per_step,
                 gained_y = dy * per_step,
                 mean_x = after.vx * per_step + frame.vx * unit - gained_x / 2,
                 mean_y = after.vy * per_step + frame.vy * unit - gained_y / 2;
    WallEvent event;
    event.body = touch.row;
    event.ix = mass * gained_x;
    event.iy = mass * gained_y;
    event.normal = event.ix * touch.nx + event.iy * touch.ny;
    event.torque = touch.y * event.ix - touch.x * event.iy;
    event.energy = event.ix * mean_x + event.iy * mean_y;
    return event;
}

/// `after` is the disc's stored state after the collision, and (dx, dy) the change of its stored
/// velocity. `axis` is 0 for the left and the right side. If `is_corner`, the disc meets two sides
/// at the same time, and the event has only the part of the impulse that is normal to its side.
inline WallEvent wall_event(const Frame& frame, std::size_t axis, double mass,
                            const DiscState& after, double dx, double dy, double unit,
                            bool is_corner) {
    const double per_step = frame.slowing * unit, gained_x = dx * per_step,
                 gained_y = dy * per_step,
                 mean_x = after.vx * per_step + frame.vx * unit - gained_x / 2,
                 mean_y = after.vy * per_step + frame.vy * unit - gained_y / 2;
    const double across = axis == 0 ? gained_x : gained_y, beside = axis == 0 ? gained_y : gained_x,
                 energy_across = across * (axis == 0 ? mean_x : mean_y),
                 energy_beside = beside * (axis == 0 ? mean_y : mean_x);
    WallEvent event;
    event.side = static_cast<std::uint8_t>(2 * axis + (across < 0 ? 1 : 0));
    event.normal = mass * (across < 0 ? -across : across);
    event.along = is_corner ? 0 : mass * beside;
    event.energy = mass * (is_corner ? energy_across : energy_across + energy_beside);
    return event;
}

} // namespace carrom

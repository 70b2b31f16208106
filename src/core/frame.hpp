// SPDX-License-Identifier: BSD-3-Clause
// The frame of reference in which states are stored, relative to the box.
//
// If discs fall, states are stored in a frame that falls freely from the last sync on. Under drag,
// times are read from a clock that slows down in the same way as the discs. In this frame discs fly
// straight at constant speed, so contacts of pairs are computed as if there were neither falling
// nor drag. In a periodic box a stored position may be outside of the box, and an image of the disc
// is inside. Without falling, drag and periodic sides the frame is at rest in the box, and states
// are not converted.
#pragma once

#include "core/disc_state.hpp"
#include "core/image.hpp"

namespace carrom {

struct Frame {
    /// Whether a stored state may differ from the state in the box, by motion, clock or image
    bool is_moving = false;
    double x = 0, y = 0;   ///< position of the frame's origin in the box
    double vx = 0, vy = 0; ///< the frame's velocity in the box, in lengths per micro-step
    double slowing = 1;    ///< rate of the frame's clock relative to the box's clock
    double clock = 0;      ///< time since the last sync on the frame's clock
    Periods periods{};     ///< periods of the box (image.hpp); 0 without periodic sides

    bool keeps_velocities() const {
        return vx == 0 && vy == 0 && slowing == 1 && !periods.are_moving();
    }

    /// The disc in the box's coordinates, at the time `time` on the frame's clock. States of
    /// departed discs are already stored in the box's coordinates.
    DiscState in_box(const DiscState& stored, double time) const {
        if (stored.has_departed()) return stored;
        DiscState disc = stored;
        disc.x = stored.x_at(time);
        disc.y = stored.y_at(time);
        disc.tau = time;
        if (!is_moving) return disc;
        disc.x += x;
        disc.y += y;
        disc.vx = disc.vx * slowing + vx;
        disc.vy = disc.vy * slowing + vy;
        periods.wrap(disc, time);
        return disc;
    }
};

} // namespace carrom

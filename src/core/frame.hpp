// SPDX-License-Identifier: BSD-3-Clause
// The frame of reference of stored states, as seen from the box.
//
// Where discs fall, states are stored in a frame that falls freely from each sync on. Under drag
// they are stored in a clock that slows down as discs do. In this frame they fly straight at
// constant speed, so contacts of pairs need neither falls nor drag. In a periodic box stored states
// fly on when a disc leaves it, and the box sees the image that is in it. Without these effects the
// frame is the box's, and nothing is computed.
#pragma once

#include "core/disc_state.hpp"
#include "core/image.hpp"

namespace carrom {

struct Frame {
    bool is_moving =
        false; ///< or has a clock of its own, or positions have to be brought into a periodic box
    double x = 0, y = 0;   ///< position of the frame's origin in the box
    double vx = 0, vy = 0; ///< the frame's velocity, per micro-step
    double slowing = 1;    ///< rate of the frame's clock relative to the box's
    double clock = 0;      ///< time on the frame's clock
    Periods periods{};     ///< periods of a periodic box

    bool keeps_velocities() const {
        return vx == 0 && vy == 0 && slowing == 1 && !periods.are_moving();
    }

    /// The disc at the frame's time `time`, as the box sees it. A disc that has left
    /// the box is already stored as the box sees it.
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

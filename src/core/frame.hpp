// SPDX-License-Identifier: BSD-3-Clause
// The frame of reference of stored states, as seen from the box.
//
// Under gravity states are stored in a frame that falls freely from each sync on. Under drag they
// are stored in a clock that slows down as discs do. There they fly straight and evenly, so pairs
// need neither. In a periodic box stored states fly on where a disc leaves it, and the box sees the
// image that is in it. Without these effects the frame is the box's, and nothing is computed.
#pragma once

#include "core/disc_state.hpp"
#include "core/image.hpp"

namespace carrom {

struct Frame {
    bool is_moving =
        false; ///< or its clock is another one, or places have to be brought into a periodic box
    double x = 0, y = 0;   ///< the origin in the box
    double vx = 0, vy = 0; ///< the frame's velocity, per micro-step
    double slowing = 1;    ///< how fast the frame's clock goes
    double clock = 0;      ///< the frame's time
    Periods periods{};     ///< periods of the box, if it is periodic

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

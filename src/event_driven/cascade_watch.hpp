// SPDX-License-Identifier: BSD-3-Clause
// Detects collisions in a block that follow each other so fast that the run would never end.
#pragma once

#include <cstdint>

namespace carrom {

class CascadeWatch {
public:
    /// Counts a collision. Returns true if there were too many collisions in too short a time. This
    /// is either a cascade within `interval` micro-steps, or a rush. In a rush, time advances so
    /// slowly that the micro-step would never end. This happens to a disc in a slot that is hardly
    /// wider than the disc, or in a wedge whose sliding surfaces drive it. The limit is lower for
    /// collisions with walls, because walls do not give way.
    bool add(double time, double interval, std::uint64_t n_discs, bool is_wall) {
        if (time > cascade_begin_ + interval) {
            cascade_begin_ = time;
            cascade_ = 0;
            if (time > rush_begin_ + rush_interval) {
                rush_begin_ = time;
                rush_ = wall_rush_ = 0;
            }
        }
        ++cascade_;
        ++rush_;
        wall_rush_ += is_wall ? 1 : 0;
        return cascade_ > 100000 + 1000 * n_discs || rush_ > 5000000 + 50000 * n_discs ||
               wall_rush_ > 200000 + 2000 * n_discs;
    }

private:
    static constexpr double rush_interval = 0x1p-16;

    double cascade_begin_ = -1, rush_begin_ = -1;
    std::uint64_t cascade_ = 0, rush_ = 0, wall_rush_ = 0;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The sides of a scene that names no effect, in the words of Sides: elastic walls at rest around
// discs that do not fall, seen in the box's own frame and clock. Nothing of it is computed.
#pragma once

#include <cstdint>

#include "core/disc.hpp"
#include "core/frame.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

class PlainBoundaries {
public:
    explicit PlainBoundaries(double box_size) : box_size_(box_size) {}

    static constexpr double clock_at(double micro_steps) { return micro_steps; }
    static constexpr double micro_steps_at(double clock) { return clock; }
    static void restart_frame(Disc& /*disc*/, double /*time*/) {}
    static Frame frame_at(double /*time*/) { return {}; }
    Extent extent_at(double /*time*/) const { return {0, box_size_, 0, box_size_}; }
    static constexpr double jump_at(double /*time*/) { return 0; }
    static constexpr bool are_any_open() { return false; }
    static constexpr double speed_gained_at(double /*time*/) { return 0; }
    static constexpr double slowing_at(double /*time*/) { return 1; }

private:
    double box_size_;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The walls and fixed bodies that discs meet, and the frame in which discs fly straight.
// Together with space, bodies and law they form a dynamics (dynamics.hpp).
//
//   PlainSurroundings        four elastic walls at rest, in the box's own frame
//   SurroundingsOfEffects    sides of any kind (boundaries.hpp), fixed bodies (fixed_bodies.hpp), a
//                            frame that falls (falling_frame.hpp)
//
// Most functions of sides are for the event-driven method. The code for walls within a micro-step
// of the time-stepped method is in time_stepped/step_walls.hpp.
#pragma once

#include "dynamics/arithmetic.hpp"
#include "dynamics/boundaries.hpp"
#include "dynamics/falling_frame.hpp"
#include "dynamics/mirror_sides.hpp"

namespace carrom {

/// The box's own clock and frame.
class RestingFrame {
public:
    explicit RestingFrame(const Effects& /*effects*/) {}

    static void begin_interval(double /*n*/) {}
    static constexpr double clock_at(double micro_steps) { return micro_steps; }
    static constexpr double micro_steps_at(double clock) { return clock; }
    static constexpr bool is_on() { return false; }
    static Frame at(double /*time*/) { return {}; }
    static void restart(DiscState& /*disc*/, double /*time*/) {}
    static constexpr double slowing_at(double /*time*/) { return 1; }
    static constexpr FlightIntegral flight_integral_at(double time) { return {time, 0, 0, 0, 0}; }
    static constexpr double pair_weight_at(double time) { return time; }
    static constexpr double jump_at(Axis /*axis*/, double /*time*/) { return 0; }
    static constexpr double speed_gained_at(double /*time*/) { return 0; }
};

template <class WhichArithmetic = StableArithmetic> struct PlainSurroundings {
    static constexpr bool have_effects = false;
    using Arithmetic = WhichArithmetic;
    using Sides = MirrorSides<Arithmetic>;
    using Flight = RestingFrame;
};

struct SurroundingsOfEffects {
    static constexpr bool have_effects = true;
    using Arithmetic = StableArithmetic;
    using Sides = Boundaries;
    using Flight = FallingFrame;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// A collision of two discs with the data that measurements need: its position, the impulse, and the
// velocities afterwards. Engines record it only if a measurement follows pairs.
//
// At a sync, lasting contacts are reported as such events, with the impulse until the next sync.
// All numbers are in the box's own frame at the time of the collision, so velocities include
// gravity and drag. Positions are not brought back into a periodic box.
#pragma once

#include <cstdint>

#include "core/disc_state.hpp"
#include "core/frame.hpp"
#include "dynamics/encounter.hpp"
#include "engine/followers.hpp"

namespace carrom {

/// Lengths are in the scene's unit; velocities and impulses are per step.
struct PairEvent {
    DiscId p = 0, q = 0; ///< p is the lower id
    /// `time` counts from the start of this micro-step; the scene's first micro-step is number 0
    std::int64_t micro_step = 0;
    double time = 0;           ///< time in micro-steps
    double x = 0, y = 0;       ///< centre of p
    double dx = 0, dy = 0;     ///< vector from the centre of p to the centre of q
    double ix = 0, iy = 0;     ///< impulse on p; q gets the opposite
    double p_vx = 0, p_vy = 0; ///< velocities after the collision
    double q_vx = 0, q_vy = 0;

    /// Time in steps since step `origin`.
    double steps_since(std::int64_t origin, std::int64_t micro_steps) const {
        return (static_cast<double>(micro_step - origin * micro_steps) + time) /
               static_cast<double>(micro_steps);
    }
};

/// Receives each pair's event on the rank that owns the first disc.
using PairFollower = EventFollower<PairEvent>;

/// Converts an event from the frame and clock of the dynamics to the box's frame and micro-steps.
/// It is not inlined, because most dynamics do not need it.
template <class Dynamics>
[[gnu::noinline]] void show_in_box(PairEvent& event, const Dynamics& dynamics, double time,
                                   double unit) {
    const Frame frame = dynamics.frame_at(time);
    event.time = dynamics.micro_steps_at(time);
    event.x += frame.x;
    event.y += frame.y;
    for (double* impulse : {&event.ix, &event.iy}) *impulse *= frame.slowing;
    for (double* v : {&event.p_vx, &event.q_vx}) *v = *v * frame.slowing + frame.vx * unit;
    for (double* v : {&event.p_vy, &event.q_vy}) *v = *v * frame.slowing + frame.vy * unit;
}

/// Writes a collision at `time`, on the clock of the dynamics, into `event`. `p` and `q` are the
/// stored states after the collision. `place` is the first disc's state before or after it, from
/// which the disc's position follows, and `to` is the separation at `time`. `unit` converts stored
/// velocities to velocities per step.
template <class Dynamics>
[[gnu::always_inline]] inline void record_in(PairEvent& event, const Dynamics& dynamics,
                                             const DiscState& place, const Separation& to,
                                             const DiscState& p, const DiscState& q,
                                             double vx_before, double vy_before, double time,
                                             double unit, std::int64_t last_sync) {
    const double momentum = dynamics.mass_of(p) * unit;
    event.p = p.id;
    event.q = q.id;
    event.micro_step = last_sync;
    event.time = time;
    event.x = place.x_at(time);
    event.y = place.y_at(time);
    event.dx = to.x;
    event.dy = to.y;
    event.ix = momentum * (p.vx - vx_before);
    event.iy = momentum * (p.vy - vy_before);
    event.p_vx = p.vx * unit;
    event.p_vy = p.vy * unit;
    event.q_vx = q.vx * unit;
    event.q_vy = q.vy * unit;
    if (dynamics.has_own_frame()) [[unlikely]]
        show_in_box(event, dynamics, time, unit);
}

} // namespace carrom

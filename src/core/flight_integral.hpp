// SPDX-License-Identifier: BSD-3-Clause
// The time integral of v_a v_b (a, b: x or y) over one disc's flight, in the box's coordinates.
//
// Between collisions a stored velocity v is constant, and the velocity in the box follows from v by
// the laws of falling and drag (core/frame.hpp). So the integral since the last sync is a known
// function of v and time: weight (v + shift)_a (v + shift)_b + rest_a rest_b, and an additional
// more_y^2 for yy if the acceleration changes its direction. If syncs change no velocities, the
// integral may extend over many syncs.
//
// For a path with collisions the integral is a sum over events. A collision at time t that changes
// v into v' adds the integral up to t for v and subtracts that integral for v'. At the end of the
// path, the integral up to that time for the last v is added.
#pragma once

namespace carrom {

/// Times are in micro-steps. Without falling and drag `weight` is the time since the integral
/// began, and all other members are 0.
struct FlightIntegral {
    double weight = 0;
    double shift_x = 0, shift_y = 0;
    double rest_x = 0, rest_y = 0;
    double more_y = 0;
};

} // namespace carrom

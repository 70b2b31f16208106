// SPDX-License-Identifier: BSD-3-Clause
// Linear drag, dv/dt = -c v, the same for all discs. After a time t a disc has moved by v s, with s
// = (1 - exp(-c t)) / c. In the clock s all discs fly straight at constant speed, so everything
// except the clock is exactly as without drag. For discs that fall see falling_frame.hpp.
//
// Except for time_of_drag_clock, the code uses only + - * /, so its bits are the same on every
// machine. Results are accurate to a few ulps.
#pragma once

namespace carrom {

/// The transformed time s = (1 - exp(-rate time)) / rate, in which discs fly at constant speed.
double drag_clock(double rate, double time);

/// The factor exp(-rate time) by which drag multiplies velocities.
double drag_slowing(double rate, double time);

/// The time at which the clock s shows `clock`. This function is for reports only, because it uses
/// the C library's logarithm, whose bits differ between machines.
double time_of_drag_clock(double rate, double clock);

} // namespace carrom

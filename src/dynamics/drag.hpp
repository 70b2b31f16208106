// SPDX-License-Identifier: BSD-3-Clause
// Linear drag, dv/dt = -c v, the same for all discs. After a time t a disc has moved by v s, with s
// = (1 - exp(-c t)) / c. In the clock s all discs fly straight at constant speed, so everything
// except the clock is exactly as without drag. For discs that fall see falling_frame.hpp.
//
// It uses only + - * /, to within some ulp, so the bits are the same on every machine.
#pragma once

namespace carrom {

/// The time on the clock at `time` after it was set to 0.
double drag_clock(double rate, double time);

/// The factor exp(-rate time) by which velocities have fallen.
double drag_slowing(double rate, double time);

/// The time at which the clock shows `clock`. It uses the C library's logarithm, whose
/// bits differ between machines, so it is for reports only.
double time_of_drag_clock(double rate, double clock);

} // namespace carrom

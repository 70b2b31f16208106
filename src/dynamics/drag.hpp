// SPDX-License-Identifier: BSD-3-Clause
// Linear drag, dv/dt = -c v for all discs alike. After a time t a disc has gone v s with
// s = (1 - exp(-c t)) / c. In the clock s all discs fly straight and evenly: everything but the
// clock is as without drag, exactly. With gravity as well: gravity.hpp.
//
// + - * / only, to within some ulp: the same bits on every machine.
#pragma once

namespace carrom {

/// What the clock shows at `time` after it was set to 0.
double drag_clock(double rate, double time);

/// exp(-rate time): what is left of a velocity.
double drag_slowing(double rate, double time);

/// The time at which the clock shows `clock`, by the C library's logarithm. For reports
/// alone: its bits differ between machines.
double time_of_drag_clock(double rate, double clock);

} // namespace carrom

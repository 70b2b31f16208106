// SPDX-License-Identifier: BSD-3-Clause
// When a point on a parabola first comes within a distance of a point at rest.
// Obstacles need this under gravity.
//
// The squared distance is a quartic of the time. The roots of its second derivative cut time
// into pieces on which the first is monotone; its roots cut it into pieces on which the distance
// is. Each has at most one root, which Newton's rule or halving finds in a bracket: + - * / and
// sqrt in a fixed order, the same bits on every machine. Price: some 20 divisions a root.
#pragma once

namespace carrom {

/// The first time s >= 0 at which |d + w s + g s^2 / 2| is not above `reach` and
/// falls; infinite if there is none. Touching counts while the distance falls, not
/// while it grows. A point that rounding has left within `reach` counts from where it
/// turns round. A graze that rounding does not see does not count. g must not be zero.
double falling_contact(double dx, double dy, double wx, double wy, double gx, double gy,
                       double reach);

} // namespace carrom

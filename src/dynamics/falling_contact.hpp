// SPDX-License-Identifier: BSD-3-Clause
// When a point on a parabola first comes within a distance of another that is at rest: what
// obstacles ask under gravity.
//
// The squared distance is a quartic of the time. Its second derivative is a quadratic, whose roots
// cut time into pieces on which the first is monotone; its roots cut it into pieces on which the
// distance is. On each at most one root, bracketed, by Newton's rule or halving: + - * / and sqrt
// in a fixed order, the same bits on every machine. Price: some 20 divisions a root.
#pragma once

namespace carrom {

/// The first time s >= 0 at which |d + w s + g s^2 / 2| is not above `reach` and falls; infinite if
/// there is none. Touching counts while the distance falls, not while it grows; one that rounding
/// has left within `reach` counts from where it turns round. A graze that rounding does not see is
/// none. g is not zero.
double falling_contact(double dx, double dy, double wx, double wy, double gx, double gy,
                       double reach);

} // namespace carrom

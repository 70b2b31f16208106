// SPDX-License-Identifier: BSD-3-Clause
// When a point on a parabola first comes within a distance of a point at rest.
// Fixed bodies need this where discs fall.
//
// The squared distance is a quartic of the time. The roots of its second derivative divide time
// into pieces on which the first derivative is monotone, and the roots of the first derivative
// divide it into pieces on which the distance is monotone. Each piece has at most one root, which
// Newton's rule or bisection finds in a bracket. Only + - * / and sqrt in a fixed order are used,
// so the bits are the same on every machine. Price: some 20 divisions a root.
#pragma once

namespace carrom {

/// The first time s >= 0 at which |d + w s + g s^2 / 2| is not above `reach` and falls; infinite if
/// there is none. Touching counts while the distance falls, not while it grows. If rounding has
/// left the point within `reach`, the contact is when it next turns back. A graze that is lost to
/// rounding does not count. g must not be zero.
double falling_contact(double dx, double dy, double wx, double wy, double gx, double gy,
                       double reach);

} // namespace carrom

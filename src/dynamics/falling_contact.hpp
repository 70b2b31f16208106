// SPDX-License-Identifier: BSD-3-Clause
// Computes when a point that moves on a parabola first comes within a given distance of a point at
// rest. Contacts of falling discs with fixed bodies need this.
//
// The squared distance is quartic in time. The roots of its second derivative divide time into
// pieces on which the first derivative is monotone, and the roots of the first derivative divide it
// into pieces on which the distance is monotone. Each piece has at most one root, which Newton's
// method or bisection finds. The code uses only + - * / and sqrt in a fixed order, so the bits are
// the same on every machine. Cost: about 20 divisions per root.
#pragma once

namespace carrom {

/// The first time s >= 0 at which |d + w s + g s^2 / 2| is at most `reach` and decreases; infinite
/// if there is none. If rounding has put the point within `reach` and the distance increases, the
/// contact is when the distance next begins to decrease. A graze that rounding turns into a miss
/// does not count. g must not be zero.
double falling_contact(double dx, double dy, double wx, double wy, double gx, double gy,
                       double reach);

} // namespace carrom

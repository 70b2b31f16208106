// SPDX-License-Identifier: BSD-3-Clause
// When a disc first touches an arc, a part of a circle without thickness. A disc of radius r meets
// the outer face of an arc of radius R where its centre comes nearer than R + r to the arc's, and
// the inner face where it gets farther than R - r, if the arc is in that direction. The ends of an
// arc are points, which are bodies of their own (fixed_bodies.hpp).
//
// On a straight flight both are roots of one quadratic, without subtracting nearly equal numbers.
// Where discs fall the distance is the root of a quartic, and is monotone in up to four pieces of
// time (falling_contact.hpp). Price: some three square roots, or some 20 divisions a root where
// discs fall.
#pragma once

namespace carrom {

/// The directions from an arc's centre in which the arc is.
struct ArcSpan {
    double ux = 1, uy = 0;    ///< the direction of its middle
    double least_cosine = -2; ///< cosine of half the angle of the arc; below -1 for a whole circle

    bool holds(double x, double y, double distance) const {
        return ux * x + uy * y >= least_cosine * distance;
    }
};

/// A disc's centre relative to the arc's centre, and its velocity.
struct ArcFlight {
    double dx, dy, wx, wy;
};

/// The first time s >= 0 at which a disc of `radius` touches either face of the arc of `arc_radius`
/// and comes nearer to it; infinite if there is none. If rounding has left the disc too near, the
/// contact is when it next comes nearer.
double arc_contact(const ArcFlight& flight, double radius, double arc_radius, const ArcSpan& span);
/// As arc_contact, for discs that fall; the acceleration must not be zero.
double falling_arc_contact(const ArcFlight& flight, double gx, double gy, double radius,
                           double arc_radius, const ArcSpan& span);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Computes when a disc first touches an arc, a part of a circle without thickness. A disc of radius
// r touches the outer face of an arc of radius R when its centre comes closer than R + r to the
// arc's centre. It touches the inner face when its centre gets further away than R - r. Both hold
// only in directions that the arc covers. Its ends are separate bodies: points (fixed_bodies.hpp).
//
// On a straight flight both times are roots of the same quadratic, computed without cancellation,
// also while the disc grows: the circle of radius R - r shrinks then (growing_contact.hpp).
// If discs fall, the time is the root of a quartic, and the distance is monotone in up to four
// intervals of time (falling_contact.hpp). Cost: some three square roots; if discs fall, some 20
// divisions for each root.
#pragma once

#include "dynamics/disc_size.hpp"

namespace carrom {

/// The range of directions, from the arc's centre, that the arc covers.
struct ArcSpan {
    double ux = 1, uy = 0;    ///< unit vector from the centre to the arc's middle
    double least_cosine = -2; ///< cosine of half the angle of the arc; below -1 for a whole circle

    bool holds(double x, double y, double distance) const {
        return ux * x + uy * y >= least_cosine * distance;
    }
};

/// A disc's position and velocity relative to the arc's centre.
struct ArcFlight {
    double dx, dy, wx, wy;
};

/// The first time s >= 0 at which a disc of this size touches either face of the arc of
/// `arc_radius` while it approaches this face; infinite if there is none. If rounding has put the
/// disc slightly into the arc, the contact is at the next time of approach.
double arc_contact(const ArcFlight& flight, const DiscSize& size, double arc_radius,
                   const ArcSpan& span);
/// Like arc_contact, for falling discs of constant radius; the acceleration must not be zero.
double falling_arc_contact(const ArcFlight& flight, double gx, double gy, double radius,
                           double arc_radius, const ArcSpan& span);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Computes when a disc first touches an arc, a part of a circle without thickness. A disc of radius
// r touches the outer face of an arc of radius R when its centre comes closer than R + r to the
// arc's centre. It touches the inner face when its centre gets further away than R - r. Both hold
// only in the directions, as seen from the arc's centre, that the arc covers. The ends of the arc
// are separate bodies, which are points (fixed_bodies.hpp).
//
// On a straight flight each of the two times is a root of a quadratic and is computed without
// cancellation. This also holds for a disc that grows, although the circle of radius R - r then
// shrinks (growing_contact.hpp). If discs fall, the time is a root of a quartic. It is searched for
// in up to four intervals of time in each of which the distance is monotone (falling_contact.hpp).
// Cost: about three square roots; if discs fall, about 20 divisions for each root.
#pragma once

#include "dynamics/disc_size.hpp"

namespace carrom {

/// The range of directions, as seen from the arc's centre, that the arc covers.
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

/// The first time s >= 0 at which a disc of this size touches either face of the arc of radius
/// `arc_radius` while it approaches this face; infinite if there is none. If rounding has made the
/// disc overlap the arc slightly, the contact is as soon as the disc approaches the face.
double arc_contact(const ArcFlight& flight, const DiscSize& size, double arc_radius,
                   const ArcSpan& span);
/// Like arc_contact, for falling discs of constant radius; the acceleration must not be zero.
double falling_arc_contact(const ArcFlight& flight, double gx, double gy, double radius,
                           double arc_radius, const ArcSpan& span);

} // namespace carrom

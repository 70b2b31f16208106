// SPDX-License-Identifier: BSD-3-Clause
// Computes when two freely flying discs touch. All contacts of pairs follow from this predicate
// (docs/understanding/method.md, section 4).
//
// With the separation d and the relative velocity v, let A = v^2, b = d v, C = d^2 - sigma^2 and X
// = d x v. The discriminant is computed as (sqrt(A) sigma - |X|)(sqrt(A) sigma + |X|), with X
// accurate to about an ulp by fused multiply-adds, and the root as C / (-b + sqrt(disc)), so no
// nearly equal numbers are subtracted (Lagrange's identity; Kahan 2004). X treats x and y alike, so
// transposed scenes give transposed bits. Most misses cost one square root, and a hit costs two
// more and a division. Nothing is divided before b < 0 is known, so equal velocities need no
// special case.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/device.hpp"

namespace carrom {

/// A contact at the time `base` + `delay`, where `base` is the later local time of the two discs.
/// There is no contact if `delay` < 0.
template <class Real> struct PairContact {
    Real base = 0;
    Real delay = -1;
    CARROM_DEVICE bool exists() const { return delay >= 0; }
};

/// The cross product ax by - ay bx, to within about an ulp of the result.
template <class Real> CARROM_DEVICE Real cross(Real ax, Real ay, Real bx, Real by) {
    const Real p1 = ax * by;
    const Real e1 = std::fma(ax, by, -p1);
    const Real p2 = ay * bx;
    const Real e2 = std::fma(ay, bx, -p2);
    return (p1 - p2) + (e1 - e2);
}

/// The time until points at separation (dx, dy) with relative velocity (vx, vy) come within
/// `sigma`; negative if they never do, or if the pair overlaps by more than `deepest_overlap`. If
/// `deepest_overlap` is infinite, all overlapping pairs that approach collide immediately. The
/// cross product is that of the separation and (wx, wy). For growing discs (wx, wy) is the velocity
/// before a rounded part along the separation was subtracted, so that this rounding has no effect
/// on a graze. Always inlined, so that the code of one dynamics does not depend on which others are
/// compiled with it.
template <class Real>
[[gnu::always_inline]] CARROM_DEVICE inline Real contact_delay(Real dx, Real dy, Real vx, Real vy,
                                                               Real wx, Real wy, Real sigma,
                                                               Real deepest_overlap) {
    const Real none = -1;
    const Real b = dx * vx + dy * vy;
    if (!(b < 0)) return none;
    const Real a = vx * vx + vy * vy;
    const Real reach = std::sqrt(a) * sigma;
    const Real x = std::fabs(cross(dx, dy, wx, wy));
    const Real disc = (reach - x) * (reach + x);
    if (!(disc > 0)) return none; // an exact graze does not count as a contact
    const Real distance = std::sqrt(dx * dx + dy * dy);
    const Real gap = distance - sigma;
    if (gap < -deepest_overlap) return none;
    if (gap <= 0) return 0;
    const Real c = gap * (distance + sigma);
    return c / (-b + std::sqrt(disc));
}
template <class Real>
[[gnu::always_inline]] CARROM_DEVICE inline Real contact_delay(Real dx, Real dy, Real wx, Real wy,
                                                               Real sigma, Real deepest_overlap) {
    return contact_delay(dx, dy, wx, wy, wx, wy, sigma, deepest_overlap);
}

/// The contact of discs `p` and `q`, in either order. It follows from the stored states alone, so
/// its bits do not depend on where and when it is computed. Always inlined, like contact_delay.
template <class Real, class AnyDisc>
[[gnu::always_inline]] CARROM_DEVICE inline PairContact<Real> pair_contact(const AnyDisc& p,
                                                                           const AnyDisc& q,
                                                                           Real sigma,
                                                                           Real deepest_overlap) {
    const Real base = std::max(p.tau, q.tau);
    const Real dx = q.x_at(base) - p.x_at(base);
    const Real dy = q.y_at(base) - p.y_at(base);
    return {base, contact_delay(dx, dy, q.vx - p.vx, q.vy - p.vy, sigma, deepest_overlap)};
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// How a wall or a fixed body changes a disc's velocity along its surface and its spin: restitution
// and Coulomb's friction of the touching surfaces, as between rough discs (law.hpp), with a body
// that cannot move.
//
// With the outward normal n of the body, t = (-n_y, n_x) and the velocity u of its surface, a disc
// with the spin W slides along the surface with the velocity h = (v - u) . t - W r. If surfaces
// stick, h becomes -e_t h: the velocity along t changes by s = -(1 + e_t) h q / (1 + q) and the
// spin by -s / (q r), where q m r^2 is the moment of inertia. For a disc that does not turn q is
// infinite. The velocity along t changes by at most `friction` times the change of normal velocity.
//
// Guarded contacts rub, too (contact_guard.hpp), because rubbing causes no endless series of
// collisions, and because a disc that rests on a floor should roll there.
#pragma once

#include <cmath>

#include "dynamics/effects.hpp"

namespace carrom {

/// The spin of a disc that meets a wall; null where discs do not turn.
struct Turning {
    double* spin = nullptr;
    double radius = 0;
};

class Rubbing {
public:
    Rubbing() = default;
    /// `surface` includes the wall's velocity. A smooth surface has a tangential restitution of -1.
    Rubbing(const Surface& surface, const ContactEffect& contact)
        : friction_(surface.friction), velocity_(surface.velocity), inertia_(contact.inertia),
          share_((1 + surface.tangential_restitution) *
                 (contact.kind == ContactKind::rough ? inertia_ / (1 + inertia_) : 1)) {}

    bool acts() const { return share_ != 0; }
    double velocity() const { return velocity_; }
    /// Coulomb's coefficient; 0 if the surface does not rub.
    double friction() const { return acts() ? friction_ : 0; }

    /// Changes the spin, and returns the change of the velocity along t. `slip` is the velocity
    /// along t of the disc's centre relative to the surface, and `pushed` is the magnitude of the
    /// change of the normal velocity.
    double rub(double slip, double pushed, const Turning& turning) const {
        if (turning.spin) slip -= turning.radius * *turning.spin;
        const double sticking = -share_ * slip, most = friction_ * pushed;
        const double change = std::fabs(sticking) > most ? std::copysign(most, sticking) : sticking;
        if (turning.spin) *turning.spin -= change / (inertia_ * turning.radius);
        return change;
    }

private:
    double friction_ = 0, velocity_ = 0, inertia_ = 1, share_ = 0;
};

} // namespace carrom

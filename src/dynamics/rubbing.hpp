// SPDX-License-Identifier: BSD-3-Clause
// What a wall or an obstacle does to a disc along its surface: restitution and Coulomb's friction
// of the surfaces that touch, as between rough discs (law.hpp), with a body that nothing
// moves.
//
// With the outward normal n of the body and t = (-n_y, n_x), the surface of a disc with the spin W
// goes along the wall's with h = (v - u) . t - W r. Where the surfaces stick, h becomes -e_t h: the
// velocity along t changes by s = -(1 + e_t) h q / (1 + q) and the spin by -s / (q r), q m r^2
// being the moment of inertia. A disc that does not turn counts as one with q without end. At most
// `friction` times the change of the normal velocity goes over to the other direction.
//
// The contact time makes no exception here: rubbing ends no series of collisions, and a disc that
// rests on a floor is to roll on it.
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
    /// `velocity` of the surface. A smooth one has the tangential restitution -1.
    Rubbing(const Surface& surface, const ContactEffect& contact)
        : friction_(surface.friction), velocity_(surface.velocity), inertia_(contact.inertia),
          share_((1 + surface.tangential_restitution) *
                 (contact.kind == ContactKind::rough ? inertia_ / (1 + inertia_) : 1)) {}

    bool acts() const { return share_ != 0; }
    double velocity() const { return velocity_; }

    /// The change of the velocity along t. `slip` is that of the disc's centre along t, relative to
    /// the surface; `pushed` the size of the change along the normal. Changes the spin.
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

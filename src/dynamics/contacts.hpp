// SPDX-License-Identifier: BSD-3-Clause
// The impulse between two discs that touch, one class for each kind of contact. It is along the
// line of centres, in units of that of an elastic contact.
#pragma once

#include <cmath>
#include <type_traits>

#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

/// Elastic contacts beside other effects. They have no guard like those of
/// InelasticContact, because this has to be fast.
class ElasticContact {
public:
    explicit ElasticContact(const ContactEffect&) {}
    double impulse() const { return 1; }
    double impulse_at(const DiscState&, const DiscState&, double) const { return 1; }
};

/// The share `restitution` of the normal relative velocity is left: 1 gives the elastic contact's
/// bits.
///
/// In the event-driven method a heap of such discs would come to infinitely many collisions in a
/// finite time (inelastic collapse: McNamara and Young 1992). So dissipation takes time, as in the
/// TC model of Luding and McNamara, Granular Matter 1, 113 (1998): if one of the two has been
/// touched within the contact time before, they part elastically. A state's own time is that of its
/// last collision or sync: the sync counts as a touch, so the guard holds across it.
class InelasticContact {
public:
    explicit InelasticContact(const ContactEffect& effect)
        : impulse_((1 + effect.restitution) / 2), contact_time_(effect.contact_time) {}

    /// For the time-stepped method, in which a disc collides at most once in a micro-step.
    double impulse() const { return impulse_; }
    /// For the event-driven method; `p` and `q` are the stored states before the contact at `time`.
    double impulse_at(const DiscState& p, const DiscState& q, double time) const {
        return time - p.tau < contact_time_ || time - q.tau < contact_time_ ? 1 : impulse_;
    }

private:
    double impulse_, contact_time_;
};

/// Discs with spin: normal and tangential restitution and Coulomb's friction (Walton and Braun, J.
/// Rheol. 30, 949 (1986); Luding, Phys. Rev. E 52, 4442 (1995)). Where the surfaces stick their
/// relative velocity along them is multiplied by minus `tangential_restitution`; where that takes
/// more than `friction` times the normal impulse, they slide.
class RoughContact {
public:
    explicit RoughContact(const ContactEffect& effect)
        : normal_((1 + effect.restitution) / 2),
          tangential_((1 + effect.tangential_restitution) / 2 *
                      (effect.inertia / (1 + effect.inertia))),
          friction_(effect.friction), inertia_(effect.inertia), contact_time_(effect.contact_time) {
    }

    /// Within the contact time discs part elastically, like smooth ones: see InelasticContact.
    bool is_guarded(const DiscState& p, const DiscState& q, double time) const {
        return time - p.tau < contact_time_ || time - q.tau < contact_time_;
    }
    double normal() const { return normal_; }
    /// The tangential impulse for the surfaces' relative velocity `slip` and the normal impulse
    /// `k`, all in one unit.
    double tangential(double slip, double k) const {
        const double sticking = tangential_ * slip, most = friction_ * std::fabs(k);
        return std::fabs(sticking) > most ? std::copysign(most, sticking) : sticking;
    }
    double inertia() const { return inertia_; }

private:
    double normal_, tangential_, friction_, inertia_, contact_time_;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The impulse between two discs that touch, one class for each kind of contact. It is along the
// line of centres, in units of that of an elastic contact.
//
// A contact is asked with the time `since` the last collision of either disc, and with `k`, the
// rate at which they approach in units of their distance: then its guard (contact_guard.hpp) may
// make it elastic. The time-stepped method has no guard, because a disc collides once in a
// micro-step at most there, so it passes `never`.
#pragma once

#include <cmath>
#include <type_traits>

#include "core/disc_state.hpp"
#include "dynamics/contact_guard.hpp"
#include "dynamics/effects.hpp"

namespace carrom {

/// Elastic contacts beside other effects.
class ElasticContact {
public:
    ElasticContact(const Effects&, double /*radius*/) {}
    static constexpr bool is_guarded(double, double) { return false; }
    static constexpr double normal() { return 1; }
    static constexpr Loss loss(double, double, bool) { return {}; }
};

/// The share `restitution` of the normal relative velocity is left: 1 gives the elastic contact's
/// bits.
class InelasticContact {
public:
    InelasticContact(const Effects& effects, double radius)
        : normal_((1 + effects.contact.restitution) / 2), guard_(effects, radius) {}

    bool is_guarded(double since, double k) const { return guard_.holds(since, k); }
    double normal() const { return normal_; }
    Loss loss(double energy, double squared_speed, bool is_guarded) const {
        return guard_.loss(energy, squared_speed, is_guarded);
    }

private:
    double normal_;
    ContactGuard guard_;
};

/// Discs with spin: normal and tangential restitution and Coulomb's friction (Walton and Braun, J.
/// Rheol. 30, 949 (1986); Luding, Phys. Rev. E 52, 4442 (1995)). Where the surfaces stick their
/// relative velocity along them is multiplied by minus `tangential_restitution`; where that takes
/// more than `friction` times the normal impulse, they slide. A guarded contact is smooth.
class RoughContact {
public:
    RoughContact(const Effects& effects, double radius)
        : RoughContact(effects.contact, ContactGuard(effects, radius)) {}

    bool is_guarded(double since, double k) const { return guard_.holds(since, k); }
    double normal() const { return normal_; }
    /// The tangential impulse for the surfaces' relative velocity `slip` and the normal impulse
    /// `k`, all in one unit.
    double tangential(double slip, double k) const {
        const double sticking = tangential_ * slip, most = friction_ * std::fabs(k);
        return std::fabs(sticking) > most ? std::copysign(most, sticking) : sticking;
    }
    double inertia() const { return inertia_; }
    Loss loss(double energy, double squared_speed, bool is_guarded) const {
        return guard_.loss(energy, squared_speed, is_guarded);
    }

private:
    RoughContact(const ContactEffect& effect, const ContactGuard& guard)
        : normal_((1 + effect.restitution) / 2),
          tangential_((1 + effect.tangential_restitution) / 2 *
                      (effect.inertia / (1 + effect.inertia))),
          friction_(effect.friction), inertia_(effect.inertia), guard_(guard) {}

    double normal_, tangential_, friction_, inertia_;
    ContactGuard guard_;
};

} // namespace carrom

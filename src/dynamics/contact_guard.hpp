// SPDX-License-Identifier: BSD-3-Clause
// Decides which collisions take no energy, because they belong to a contact that lasts.
//
// Discs that lose energy would come to infinitely many collisions in a finite time (inelastic
// collapse: McNamara and Young, Phys. Fluids A 4, 496 (1992)). So dissipation takes time, as in the
// TC model of Luding and McNamara, Granular Matter 1, 113 (1998): a disc that has collided a
// contact time before collides elastically. By default a contact is a length, not a time: the
// collision is elastic if the two have closed in by less than a millionth of the sum of their radii
// since the last collision of either. So the guard is the same in all units, and follows discs as
// they cool. At walls and fixed bodies the share is a hundred times larger: they do not give way,
// so whatever presses a disc to one or into the wedge between two brings it back without end. A
// scene may name a time instead, which costs fewer collisions where discs lie at rest.
//
// If discs are pulled to a wall, a contact at rest is a series of small bounces without loss. The
// energy that they keep is no error, so it does not count as lost by the guard. Slow contacts that
// last lose their energy at syncs, so they do not count either.
//
// Only collisions count as contacts, syncs and starts do not. A disc's last collision is forgotten
// at a sync, so its first collision after the sync is guarded only through its partner.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/never.hpp"

namespace carrom {

/// Time since the last collision of a disc within this sync interval.
CARROM_DEVICE inline double since_collision(const DiscState& disc, double time) {
    return disc.has_collided ? time - disc.tau : never;
}

class ContactGuard {
public:
    /// The share of the distance between centres that two discs close in by during a contact.
    static constexpr double pair_share = 1e-6;
    /// This share for a disc and its image behind a wall.
    static constexpr double wall_share = 1e-4;

    /// For discs of at most `radius`.
    ContactGuard(const Effects& effects, double radius)
        : contact_time_(effects.contact.contact_time) {
        const double pull = effects.acceleration().largest() + largest_wall_pull(effects);
        rest_speed_ = std::max(rest_factor * least_departure(pull, radius), effects.lasting_speed);
    }

    /// `since`: the time since the last collision of either. `closing`: how fast they approach, in
    /// sums of their radii.
    CARROM_DEVICE bool holds(double since, double closing) const {
        return holds(since, closing, pair_share);
    }
    /// At a wall a disc approaches its own image, at twice its speed and twice its radius.
    bool holds_at_wall(double since, double speed, double radius) const {
        return holds(since, speed / radius, wall_share);
    }

    /// The smallest speed at which a disc leaves a wall that `pull` presses it against, so that it
    /// is back a contact later.
    double least_departure(double pull, double radius) const {
        if (!(pull > 0)) return 0;
        return contact_time_ > 0 ? 0.5 * pull * contact_time_
                                 : std::sqrt(0.5 * wall_share * radius * pull);
    }
    /// The time after which a disc that leaves a wall with `least_departure` is back.
    double rest_time(double pull, double radius) const {
        if (contact_time_ > 0) return contact_time_;
        return pull > 0 ? 2 * least_departure(pull, radius) / pull : 0;
    }

    /// The energy that a collision takes, or spares if it is guarded. `energy` is what restitution
    /// takes. A guarded contact at rest counts as 0.
    CARROM_DEVICE Loss loss(double energy, double squared_speed, bool is_guarded) const {
        if (!is_guarded) return {energy, 0};
        return {0, squared_speed > rest_speed_ * rest_speed_ ? energy : 0};
    }

private:
    /// A contact at rest is disturbed by its neighbours, so this many times the speed of departure
    /// counts as rest.
    static constexpr double rest_factor = 10;

    CARROM_DEVICE bool holds(double since, double closing, double share) const {
        return contact_time_ > 0 ? since < contact_time_ : since * std::fabs(closing) < share;
    }

    double contact_time_; ///< 0: a length is used instead
    double rest_speed_;   ///< slower contacts are at rest
};

} // namespace carrom

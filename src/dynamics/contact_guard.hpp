// SPDX-License-Identifier: BSD-3-Clause
// Decides which collisions are guarded: they lose no energy, because they are part of a contact
// that lasts.
//
// Discs that lose energy would undergo infinitely many collisions in a finite time (inelastic
// collapse: McNamara and Young, Phys. Fluids A 4, 496 (1992)). The TC model of Luding and McNamara,
// Granular Matter 1, 113 (1998), prevents this: a disc that has collided within the last contact
// time collides elastically. By default the limit is a length instead: a collision is elastic if
// the two discs have approached by less than a millionth of the sum of their radii since the last
// collision of either. This limit depends neither on units nor on the speeds of discs. At walls and
// fixed bodies the limit is a hundred times larger, because a disc that is pressed to one, or into
// a wedge between two, would collide with them again and again. A scene may set a contact time
// instead, which saves collisions where discs lie at rest.
//
// If discs are pulled to a wall, a contact at rest is a series of small bounces without loss. The
// energy that these bounces keep is not counted as spared by the guard. Slow lasting contacts lose
// their energy at syncs, so they are not counted either.
//
// Syncs and starts do not count as contacts. A sync resets the last collision of each disc, so the
// first collision of a disc after a sync is guarded only if its partner has collided since then.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/device.hpp"
#include "core/disc_state.hpp"
#include "dynamics/effects.hpp"
#include "dynamics/loss.hpp"
#include "dynamics/never.hpp"

namespace carrom {

/// Time since the last collision of a disc in this sync interval; infinite if there was none.
CARROM_DEVICE inline double since_collision(const DiscState& disc, double time) {
    return disc.has_collided ? time - disc.tau : never;
}

class ContactGuard {
public:
    /// A collision is guarded if the discs have approached by less than this share of the sum of
    /// their radii since the last collision of either.
    static constexpr double pair_share = 1e-6;
    /// The same limit for a disc and its mirror image behind a wall or a fixed body.
    static constexpr double wall_share = 1e-4;

    /// No disc is larger than `radius`.
    ContactGuard(const Effects& effects, double radius)
        : contact_time_(effects.contact.contact_time) {
        const double pull = effects.acceleration().largest() + largest_wall_pull(effects);
        rest_speed_ = std::max(rest_factor * least_departure(pull, radius), effects.lasting_speed);
    }

    /// `since`: time since the last collision of either disc. `closing`: speed of approach, in sums
    /// of the two radii per micro-step.
    CARROM_DEVICE bool holds(double since, double closing) const {
        return holds(since, closing, pair_share);
    }
    /// At a wall a disc approaches its mirror image, at twice its speed; their radii are equal.
    bool holds_at_wall(double since, double speed, double radius) const {
        return holds(since, speed / radius, wall_share);
    }

    /// The smallest speed at which a disc leaves a wall to which the acceleration `pull` presses
    /// it. At this speed the disc is away so long that its next collision is just not guarded.
    double least_departure(double pull, double radius) const {
        if (!(pull > 0)) return 0;
        return contact_time_ > 0 ? 0.5 * pull * contact_time_
                                 : std::sqrt(0.5 * wall_share * radius * pull);
    }
    /// The time after which a disc that leaves a wall with the speed `least_departure` is back.
    double rest_time(double pull, double radius) const {
        if (contact_time_ > 0) return contact_time_;
        return pull > 0 ? 2 * least_departure(pull, radius) / pull : 0;
    }

    /// The energy loss of a collision in which restitution would take `energy`. A guarded collision
    /// spares this energy; at a contact at rest, the spared energy counts as 0.
    CARROM_DEVICE Loss loss(double energy, double squared_speed, bool is_guarded) const {
        if (!is_guarded) return {energy, 0};
        return {0, squared_speed > rest_speed_ * rest_speed_ ? energy : 0};
    }

private:
    /// Contacts with speeds up to this many times `least_departure` count as at rest, because
    /// neighbours disturb a disc at rest.
    static constexpr double rest_factor = 10;

    CARROM_DEVICE bool holds(double since, double closing, double share) const {
        return contact_time_ > 0 ? since < contact_time_ : since * std::fabs(closing) < share;
    }

    double contact_time_; ///< if 0, contacts are limited by a length instead
    double rest_speed_;   ///< guarded contacts up to this speed count as at rest
};

} // namespace carrom

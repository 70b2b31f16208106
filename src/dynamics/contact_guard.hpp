// SPDX-License-Identifier: BSD-3-Clause
// Decides which collisions are guarded. Restitution takes no energy from a guarded collision,
// because the collision is part of a contact that lasts.
//
// Discs that lose energy would undergo infinitely many collisions in a finite time (inelastic
// collapse: McNamara and Young, Phys. Fluids A 4, 496 (1992)). The TC model of Luding and McNamara,
// Granular Matter 1, 113 (1998), prevents this: a disc that has collided within the last contact
// time collides elastically. By default the limit is a length instead: a collision is elastic if
// the two discs have approached by less than a millionth of the sum of their radii since the last
// collision of either. This limit depends neither on units nor on the speeds of discs. At walls and
// fixed bodies the limit is a hundred times larger, because a disc that is pressed against one of
// them, or into a wedge between two, would collide with them again and again. A scene may set a
// contact time instead, which reduces the number of collisions where discs lie at rest.
//
// If discs are pulled to a wall, a contact at rest is a series of small bounces without loss. The
// energy that restitution would take from these bounces is not counted as spared by the guard. The
// energy of slow lasting contacts is not counted either, because it is lost at syncs.
//
// Syncs and the start of a run do not count as collisions. At a sync the last collision of each
// disc is forgotten, so the first collision of a disc after a sync is guarded only if its partner
// has collided since the sync.
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

    /// `radius` is the largest radius of a disc.
    ContactGuard(const Effects& effects, double radius)
        : contact_time_(effects.contact.contact_time) {
        const double pull = effects.acceleration().largest() + largest_wall_pull(effects);
        rest_speed_ = std::max(rest_factor * least_departure(pull, radius), effects.lasting_speed);
    }

    /// Whether a collision is guarded. `since` is the time since the last collision of either disc,
    /// and `closing` is the speed of approach divided by the sum of the two radii.
    CARROM_DEVICE bool holds(double since, double closing) const {
        return holds(since, closing, pair_share);
    }
    /// The same at a wall. The partner is the disc's mirror image, which has the same radius, and
    /// the two approach at twice the disc's speed relative to the wall, `speed`.
    bool holds_at_wall(double since, double speed, double radius) const {
        return holds(since, speed / radius, wall_share);
    }

    /// The smallest speed at which a disc leaves a wall against which the acceleration `pull`
    /// presses it. The disc is then away just long enough for its next collision to be unguarded.
    double least_departure(double pull, double radius) const {
        if (!(pull > 0)) return 0;
        return contact_time_ > 0 ? 0.5 * pull * contact_time_
                                 : std::sqrt(0.5 * wall_share * radius * pull);
    }
    /// The time from leaving a wall at the speed `least_departure` to touching it again.
    double rest_time(double pull, double radius) const {
        if (contact_time_ > 0) return contact_time_;
        return pull > 0 ? 2 * least_departure(pull, radius) / pull : 0;
    }

    /// The energy loss of a collision in which restitution would take `energy`; `squared_speed` is
    /// that of the approach. A guarded collision spares this energy, but the energy spared by
    /// contacts at rest counts as 0.
    CARROM_DEVICE Loss loss(double energy, double squared_speed, bool is_guarded) const {
        if (!is_guarded) return {energy, 0};
        return {0, squared_speed > rest_speed_ * rest_speed_ ? energy : 0};
    }

private:
    /// Guarded contacts at speeds up to this many times `least_departure` count as at rest. The
    /// factor allows for neighbours, which disturb a disc at rest.
    static constexpr double rest_factor = 10;

    CARROM_DEVICE bool holds(double since, double closing, double share) const {
        return contact_time_ > 0 ? since < contact_time_ : since * std::fabs(closing) < share;
    }

    double contact_time_; ///< if 0, the limit is a length instead
    double rest_speed_;   ///< guarded contacts up to this speed count as at rest
};

} // namespace carrom

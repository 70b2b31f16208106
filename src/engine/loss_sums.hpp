// SPDX-License-Identifier: BSD-3-Clause
// The energy that restitution has taken, and the energy that it would have taken in collisions that
// were made elastic (dynamics/contact_guard.hpp). The sums are exact, so they do not depend on the
// order of collisions.
#pragma once

#include <cstdint>

#include <carrom/totals.hpp>

#include "core/exact_sum.hpp"
#include "dynamics/loss.hpp"
#include "parallel/communicator.hpp"

namespace carrom {

struct LossSums {
    /// `bound` exceeds each sum; its unit is mass times squared length per squared micro-step, and
    /// it is the same on all ranks.
    explicit LossSums(double bound) : taken(bound), spared(bound) {}

    /// `slowing` is the slowing factor of the dynamics' clock at the time of the collision.
    void add(const Loss& loss, double slowing) {
        if (loss.taken != 0) taken.add(loss.taken * slowing * slowing);
        if (loss.spared == 0) return;
        spared.add(loss.spared * slowing * slowing);
        n_guarded += 1;
    }
    LossSums& operator+=(const LossSums& other) {
        taken += other.taken;
        spared += other.spared;
        n_guarded += other.n_guarded;
        return *this;
    }

    ExactSum taken, spared;
    std::uint64_t n_guarded = 0; ///< collisions made elastic, except contacts at rest
};

/// Adds up the losses of all ranks and writes them to `totals`. **Collective.**
void add_losses(const LossSums& mine, std::int64_t micro_steps, const Communicator& communicator,
                Totals& totals);

} // namespace carrom

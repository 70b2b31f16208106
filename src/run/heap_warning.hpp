// SPDX-License-Identifier: BSD-3-Clause
// Warns once of a run whose discs lie on each other and so collide without end, and of one whose
// contacts should last and do not, because discs flow past each other too fast.
//
// The contact time bounds how often a disc at rest collides: some times in each contact time. Discs
// that fly collide far less often, because a contact time is much shorter than their flights. So
// more than one collision of a disc in a contact time, in the mean over the time between two syncs,
// tells heaps from gases at any speed and density. Where contacts last, a disc collides a few times
// between two syncs. In a flow with too small a `speed` it has a hundred collisions: discs that
// meet faster are no lasting contacts, and bounce in the crowd until the next sync. Price: a sum
// over the discs and the ranks in that time, in scenes with gravity and losses alone.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "parallel/communicator.hpp"
#include "run/messages.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

class HeapWarning : public StepAction {
public:
    HeapWarning(const SceneParameters& scene, const DiscSystem& system, const Communicator& ranks,
                Messages messages);

    /// Whether discs of the scene may come to rest.
    static bool may_warn(const SceneParameters& scene);

    std::int64_t next_due(std::int64_t /*step*/) const override {
        return std::numeric_limits<std::int64_t>::max();
    }
    bool act() override;

private:
    /// The rest of a warning for so many collisions of a disc in a step; empty without a reason.
    std::string text_on_rest(double per_step) const;
    std::string text_on_flow(double per_step) const; ///< **Collective.**
    double speed_of_passing() const;                 ///< **Collective.**
    /// Of all discs so far; a pair's counts twice. **Collective.**
    std::uint64_t n_collisions() const;

    const SceneParameters& scene_;
    const DiscSystem& system_;
    Communicator ranks_;
    Messages messages_;
    bool is_watching_;
    std::int64_t last_step_ = 0;
    std::uint64_t last_collisions_ = 0;
};

} // namespace carrom

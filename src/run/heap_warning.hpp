// SPDX-License-Identifier: BSD-3-Clause
// Warns once if discs lie on each other and so collide for ever, and if contacts that should last
// do not, because discs flow past each other too fast.
//
// A disc at rest collides a few times in each contact time. A flying disc collides far less often,
// because its flights are much longer than a contact time. So more than one collision of a disc in
// a contact time, averaged over the time between two syncs, distinguishes heaps from gases at any
// speed and density. If contacts last, a disc collides a few times between two syncs. In a flow
// with too small a `speed` it has about a hundred collisions, because faster contacts do not last,
// and such discs bounce between their neighbours until the next sync. Price: a sum over discs and
// ranks at each sync, only in scenes with falling discs and losses.
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

    /// Whether discs of the scene can come to rest.
    static bool may_warn(const SceneParameters& scene);

    std::int64_t next_due(std::int64_t /*step*/) const override {
        return std::numeric_limits<std::int64_t>::max();
    }
    bool act() override;

private:
    /// The text of a warning for this number of collisions of a disc in a step; empty if there is
    /// no reason.
    std::string text_on_rest(double per_step) const;
    std::string text_on_flow(double per_step) const; ///< **Collective.**
    double speed_of_passing() const;                 ///< **Collective.**
    /// Collisions of all discs so far; a collision of a pair counts twice. **Collective.**
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

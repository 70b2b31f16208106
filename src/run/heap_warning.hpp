// SPDX-License-Identifier: BSD-3-Clause
// Warns once if discs lie on each other and so collide without end, or if discs flow past each
// other too fast for their contacts to last.
//
// A disc at rest collides a few times in each contact time. A flying disc collides far less often,
// because its flights are much longer than a contact time. So a disc in a heap has more than one
// collision per contact time, on average between two syncs, and a disc in a gas has fewer at any
// speed and density. Lasting contacts leave a few collisions of a disc between two syncs. If
// effects.lasting_contacts.speed is too small for a flow, its discs bounce between neighbours
// instead, about a hundred times until the next sync. Cost: a sum over discs and ranks at each
// sync, only in scenes where discs fall and lose energy.
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
    /// The text of a warning for this mean number of collisions of each disc in a step; empty if
    /// discs are not at rest on each other.
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

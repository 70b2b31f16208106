// SPDX-License-Identifier: BSD-3-Clause
// Lets effects act at a sync on the discs of a rank.
#pragma once

#include "domain/strip_discs.hpp"
#include "dynamics/sync_effect.hpp"
#include "engine/wall_event.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

namespace carrom {

class SyncAction {
public:
    SyncAction(const Scene& scene, const SpeciesTable& species, const Communicator& communicator,
               int n_threads);

    bool has_effects() const { return !effects_.empty(); }
    /// Called when the halo is forgotten and all states have been brought to the time of the sync.
    /// Adds to `energy_given()`, and gives `walls` what walls give to discs at rest until the next
    /// sync. **Collective.**
    void act(StripDiscs& discs, std::int64_t n_syncs, const Followers<WallEvent>& walls);
    /// Kinetic energy that effects have given to discs of this rank since the run began, spins
    /// included, per micro-step. For checks: its last bits depend on the machine shape.
    double energy_given() const { return energy_given_; }

private:
    std::vector<std::byte> gathered(std::span<const std::byte> mine) const;
    double energy_of(const SyncDiscs& at) const;
    /// Adds the flow of sheared discs, so many times, to velocities and spins.
    void add_flow(const SyncDiscs& at, double times) const;

    SyncEffects effects_;
    SpeciesTable species_;
    double inertia_;
    double micro_steps_; ///< of a step
    Box box_;
    double shear_; ///< per micro-step
    Communicator communicator_;
    int n_threads_;
    double energy_given_ = 0;
};

} // namespace carrom

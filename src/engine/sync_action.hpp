// SPDX-License-Identifier: BSD-3-Clause
// Lets effects act at a sync on the discs of a rank.
#pragma once

#include "domain/strip_discs.hpp"
#include "dynamics/sync_effect.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

class SyncAction {
public:
    SyncAction(const SceneParameters& scene, const SpeciesTable& species,
               const Communicator& communicator, int n_threads);

    bool has_effects() const { return !effects_.empty(); }
    /// Called when the halo is forgotten and all states have been brought to the time of the sync.
    /// Adds to `energy_given()`. **Collective.**
    void act(StripDiscs& discs, std::int64_t n_syncs);
    /// Kinetic energy that effects have given to discs of this rank since the run began, spins
    /// included, per micro-step. For checks: its last bits depend on the machine shape.
    double energy_given() const { return energy_given_; }

private:
    double energy_of(const SyncDiscs& at) const;
    /// Adds the flow of sheared discs, so many times, to velocities and spins.
    void add_flow(const SyncDiscs& at, double times) const;

    SyncEffects effects_;
    SpeciesTable species_;
    double inertia_;
    Box box_;
    double shear_; ///< per micro-step
    Communicator communicator_;
    int n_threads_;
    double energy_given_ = 0;
};

} // namespace carrom

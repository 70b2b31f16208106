// SPDX-License-Identifier: BSD-3-Clause
// Lets effects act at a sync on the discs of a rank.
#pragma once

#include <cstdint>
#include <functional>

#include "domain/strip_discs.hpp"
#include "dynamics/sync_effect.hpp"
#include "engine/pair_event.hpp"
#include "engine/stress_sums.hpp"
#include "engine/wall_event.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Receive the impulses that effects give at a sync.
struct SyncNotes {
    const Followers<WallEvent>* walls = nullptr;
    const Followers<PairEvent>* pairs = nullptr;
    StressSums* stress = nullptr; ///< null if nobody asks
    std::int64_t micro_step = 0;  ///< of the sync
};

class SyncAction {
public:
    SyncAction(const SceneParameters& scene, const SpeciesTable& species,
               const Communicator& communicator, int n_threads);

    bool has_effects() const { return !effects_.empty(); }
    /// The largest reach that an effect asks for at this sync.
    double reach(std::int64_t n_syncs) const;
    /// Called when all states have been brought to the time of the sync. There is no halo, or one
    /// as deep as the reach, which `visit_near_pairs` searches. Adds to `energy_given()` and to
    /// what `notes` names. **Collective.**
    void act(StripDiscs& discs, std::int64_t n_syncs, const SyncNotes& notes,
             const std::function<void(const SyncDiscs::VisitNear&)>& visit_near_pairs = {});
    /// Whether some effect acts before flights, too.
    bool begins() const;
    /// Called before the flights after a sync, or from the scene's start on; all states are at that
    /// time. Adds to `energy_given()`. **Collective.**
    void begin(StripDiscs& discs, std::int64_t n_syncs);
    /// Kinetic energy that effects have given to discs of this rank since the run began, spins
    /// included, per micro-step. For checks: its last bits depend on the machine shape.
    double energy_given() const { return energy_given_; }

    /// What effects keep, one after the other, each after the count of its numbers; empty if none
    /// keeps any.
    std::vector<std::int64_t> kept() const;
    void go_on(std::span<const std::int64_t> kept);

private:
    SyncDiscs at_sync(StripDiscs& discs, std::int64_t n_syncs) const;
    template <class What> void change(const SyncDiscs& at, const What& what);
    void follow(SyncDiscs& at, const SyncNotes& notes) const;
    PairEvent event_of(const PairImpulse& pair, std::int64_t micro_step) const;
    std::vector<std::byte> gathered(std::span<const std::byte> mine) const;
    double energy_of(const SyncDiscs& at) const;
    /// Adds the flow of sheared discs, so many times, to velocities and spins.
    void add_flow(const SyncDiscs& at, double times) const;

    SyncEffects effects_;
    SpeciesTable species_;
    double inertia_, micro_steps_;
    Box box_;
    double shear_; ///< per micro-step
    Communicator communicator_;
    int n_threads_;
    double energy_given_ = 0;
};

} // namespace carrom

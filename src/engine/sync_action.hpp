// SPDX-License-Identifier: BSD-3-Clause
// Applies the effects of a sync to the discs of a rank.
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

/// The receivers of the impulses that effects give at a sync.
struct SyncNotes {
    const Followers<WallEvent>* walls = nullptr;
    const Followers<PairEvent>* pairs = nullptr;
    StressSums* stress = nullptr; ///< null if no measurement needs it
    std::int64_t micro_step = 0;  ///< micro-step of the sync
};

class SyncAction {
public:
    SyncAction(const SceneParameters& scene, const SpeciesTable& species,
               const Communicator& communicator, int n_threads);

    bool has_effects() const { return !effects_.empty(); }
    /// The change of radii by an effect; null if no effect changes radii.
    SizeChange* sizes() const {
        for (const auto& effect : effects_)
            if (SizeChange* const its = effect->sizes()) return its;
        return nullptr;
    }
    /// The change of the box's sides by an effect; null if no effect changes them.
    ShapeChange* shape() const;
    /// The source of an effect that lets discs in; null if there is none.
    DiscSource* source() const {
        for (const auto& effect : effects_)
            if (DiscSource* const its = effect->source()) return its;
        return nullptr;
    }
    /// The largest distance up to which effects need pairs at this sync, divided by Engine::size.
    double reach(std::int64_t n_syncs) const;
    /// Lets effects act. All states must be at the time of the sync. There must be either no halo
    /// or one that is as deep as the reach that `visit_near_pairs` searches. Adds to
    /// `energy_given()` and to the sums in `notes`. **Collective.**
    void act(StripDiscs& discs, std::int64_t n_syncs, const SyncNotes& notes,
             const std::function<void(const SyncDiscs::VisitNear&)>& visit_near_pairs = {});
    /// Whether an effect also acts before the flights that follow a sync.
    bool begins() const;
    /// Lets effects act before the flights that follow a sync or the scene's start; all states must
    /// be at that time. Adds to `energy_given()`. **Collective.**
    void begin(StripDiscs& discs, std::int64_t n_syncs);
    /// Kinetic energy, rotation included, that effects have given to own discs since the run began;
    /// the unit of time is a micro-step. For checks: its last bits depend on ranks and threads.
    double energy_given() const { return energy_given_; }

    /// The values that effects keep: for each effect the number of its values, then the values.
    /// Empty if no effect keeps any.
    std::vector<std::int64_t> kept() const;
    void go_on(std::span<const std::int64_t> kept);
    /// The box of a state whose effects kept these values: the scene's box, unless an effect has
    /// changed its sides.
    static Box box_at(const SceneParameters& scene, std::span<const std::int64_t> kept);

private:
    SyncDiscs at_sync(StripDiscs& discs, std::int64_t n_syncs) const;
    template <class What> void change(const SyncDiscs& at, const What& what);
    void follow(SyncDiscs& at, const SyncNotes& notes) const;
    PairEvent event_of(const PairImpulse& pair, std::int64_t micro_step) const;
    std::vector<std::byte> gathered(std::span<const std::byte> mine) const;
    double energy_of(const SyncDiscs& at) const;
    /// Adds the mean flow of a sheared box, multiplied by `times`, to velocities and spins.
    void add_flow(const SyncDiscs& at, double times) const;

    SyncEffects effects_;
    SpeciesTable species_;
    double inertia_, micro_steps_;
    Box box_;
    double shear_; ///< rate of shear per micro-step
    Communicator communicator_;
    int n_threads_;
    double energy_given_ = 0;
};

} // namespace carrom

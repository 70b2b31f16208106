// SPDX-License-Identifier: BSD-3-Clause
// An engine moves a run's discs. There is one class of engines for each method, and a
// run has one engine from its start to its end.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <carrom/box.hpp>

#include "cell_list/cell_grid.hpp"
#include "cell_list/population.hpp"
#include "core/disc_state.hpp"
#include "core/frame.hpp"
#include "domain/domains.hpp"
#include "dynamics/species.hpp"
#include "engine/collision.hpp"
#include "engine/device_facts.hpp"
#include "engine/loss_sums.hpp"
#include "engine/pair_event.hpp"
#include "engine/stored_state.hpp"
#include "engine/stress_sums.hpp"
#include "engine/totals.hpp"
#include "engine/tuning.hpp"
#include "engine/wall_event.hpp"

namespace carrom {

/// A rank's discs at `time`, arranged as at the start of a window: own discs in their domain, then
/// the halo, all sorted into cells.
struct LocalView {
    Population population;
    const CellGrid* grid = nullptr; ///< reaches at least a diameter and local_view's `reach`
    const Domains* domains = nullptr;
    double time = 0;   ///< time since the last sync
    Frame frame;       ///< the frame in which the discs' coordinates are stored
    Periods periods{}; ///< periods of a periodic box, by which images of discs are displaced
    double size = 1;   ///< the value of Engine::size
};

class Engine {
public:
    Engine() = default;
    virtual ~Engine() = default;
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// See DiscSystem::advance_towards. **Collective.**
    virtual void advance_towards(std::int64_t last_step) = 0;
    /// Fills in totals that only the engine has: overlaps, rejected candidates, energy lost.
    /// **Collective.**
    virtual void add_to(Totals& totals) = 0;
    /// Redistributes the discs at the present time, so that pairs within a diameter, or within
    /// `reach` if that is more, can be inspected. The view is valid until the next step.
    /// **Collective.**
    virtual LocalView local_view(double reach = 0) = 0;
    /// Removes the images of own discs that local_view has added in a periodic box.
    virtual void forget_images() = 0;

    /// The GPU that moves the discs of this engine; its name is empty if no GPU is used.
    virtual DeviceFacts device() const { return {}; }
    /// Extra bytes per disc if discs are clustered, compared with a homogeneous gas. Equal on all
    /// ranks.
    virtual double bytes_for_crowds() const { return 0; }
    /// Counts of windows and blocks of all ranks. **Collective.**
    virtual RollbackCounts rollback_counts() const { return {}; }

    virtual std::int64_t micro_steps_done() const = 0; ///< micro-steps since the scene's start
    virtual std::span<const DiscState> own() const = 0;
    virtual std::span<const DiscState> departed()
        const = 0; ///< the discs of this rank that have left the box; own() does not contain them
    virtual SideSpans side_columns() const { return {}; } ///< values for the discs in `own()`
    /// The side columns (side_columns.hpp) of the discs in `departed()`, in the same order.
    virtual SideSpans departed_columns() const { return {}; }
    virtual const SpeciesTable& species_table() const = 0;
    /// The factor by which an effect at syncs has changed all radii of `species_table()`.
    virtual double size() const { return 1; }
    /// The present side lengths of the box. An effect may change them; moving walls do not.
    virtual Box box() const = 0;
    virtual double clock() const = 0;
    virtual Frame frame() const { return {}; } ///< the frame of the own discs at `clock()`
    /// Number of discs on all ranks, departed ones included
    virtual std::uint64_t n_discs() const = 0;
    /// See SyncAction::energy_given.
    virtual double energy_given() const { return 0; }
    /// The values that effects keep for the next sync; part of StoredState
    virtual std::vector<std::int64_t> kept_by_effects() const { return {}; }
    virtual PhaseSeconds phase_seconds() const = 0;
    /// Largest number of ranks that share a strip; equal on all ranks
    virtual int most_ranks_across() const = 0;

    /// See DiscSystem::log_to. Engines append the collisions that they carry out to `log_`, unless
    /// it is null.
    void log_to(std::vector<Collision>* log) { log_ = log; }
    /// Followers of this rank's collisions: of two discs, and of discs with sides and fixed bodies.
    Followers<PairEvent>& followers_of_pairs() { return pair_followers_; }
    Followers<WallEvent>& followers_of_walls() { return wall_followers_; }
    /// From now on the energy that moving images give to own discs is added to `work`, in
    /// the unit of stored states, mass times squared length per squared micro-step. Null ends this.
    void add_work_to(double* work) { work_ = work; }
    /// From now on `act` is called at each sync before the effects act, when all states are at the
    /// time of the sync. It must not change states. An empty function ends this.
    void call_before_effects(std::function<void()> act) { before_effects_ = std::move(act); }
    /// From now on the contributions of own discs to the time integral of stress are added to
    /// this rank's `sums`; null ends this. The owner of a pair's first disc adds the collision.
    void add_stress_to(StressSums* sums) {
        stress_ = sums;
        if (!sums) return;
        no_stress_ = *sums;
        no_stress_.clear();
    }
    /// Starts sums of energy lost in collisions; `bound` exceeds each sum. Call it before any step.
    void begin_loss_sums(double bound) { losses_ = no_losses_ = LossSums(bound); }
    /// Coefficients of the integral over those flights that the sums of stress do not contain yet.
    virtual FlightIntegral flight_integral() const { return {}; }
    /// From now on each sync in a periodic box appends to `crossings` the own discs that it brings
    /// back into the box, until `forget_crossings_in` is called.
    void record_crossings_in(std::vector<Crossing>& crossings) { crossings_.push_back(&crossings); }
    void forget_crossings_in(std::vector<Crossing>& crossings) {
        std::erase(crossings_, &crossings);
    }

protected:
    /// Records that the disc was brought back from (x, y) to its position in the box. Thread-safe.
    void record_crossing(const DiscState& disc, double x, double y, const Periods& periods);
    bool is_followed() const {
        return log_ != nullptr || wall_followers_.are_any() || pair_followers_.are_any();
    }

    std::vector<Collision>* log_ = nullptr;
    Followers<PairEvent> pair_followers_;
    Followers<WallEvent> wall_followers_;
    StressSums* stress_ = nullptr;
    double* work_ = nullptr;
    std::function<void()> before_effects_;
    /// Empty sums from which partial sums are copied. Until a measurement needs sums, the unit is
    /// so large that all terms are rounded to 0.
    StressSums no_stress_{0x1p900};
    LossSums losses_{0x1p900}, no_losses_{0x1p900};
    std::vector<std::vector<Crossing>*> crossings_;
};

} // namespace carrom

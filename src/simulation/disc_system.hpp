// SPDX-License-Identifier: BSD-3-Clause
// All discs of a run and the engine that moves them forward in time. It opens no file and prints
// nothing.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/disc_state.hpp"
#include "core/frame.hpp"
#include "engine/collision.hpp"
#include "engine/pair_event.hpp"
#include "engine/stored_state.hpp"
#include "engine/totals.hpp"
#include "engine/tuning.hpp"
#include "engine/wall_event.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct AveragedSystem;
class Engine;
class StateCheck;
struct BondOrder;
struct HexaticSums;
struct LocalView;
struct MotionSample;
struct StressSums;

class DiscSystem {
public:
    /// Takes the scene's `discs` (velocities per step, tau 0), in any
    /// distribution over the ranks. Velocities become those per micro-step.
    /// **Collective.**
    DiscSystem(const SceneParameters& scene, std::vector<InputDisc> discs,
               const Communicator& communicator, const Tuning& tuning);
    /// Goes on from a stored state of the same scene, in any distribution over the
    /// ranks. **Collective.**
    DiscSystem(const SceneParameters& scene, StoredState state, const Communicator& communicator,
               const Tuning& tuning);
    ~DiscSystem();

    /// Runs until `last_step`, or until an earlier step that is a good one to read the state at (at
    /// least one step on). Steps are the scene's. **Collective.**
    void advance_towards(std::int64_t last_step);

    std::int64_t step() const;
    std::int64_t micro_steps_done() const;

    /// Own discs in no particular order: velocities per micro-step, times on `clock()`. Those that
    /// have left the box are among them (DiscState::has_departed). Good until the next call.
    std::span<const DiscState> discs() const;
    /// The numbers of side columns along `discs()`. Good until the next call.
    SideSpans side_columns() const;
    /// What effects keep from sync to sync, for StoredState; equal on all ranks.
    std::vector<std::int64_t> kept_by_effects() const;
    /// The spins, in angles per micro-step; empty if discs are not rough.
    std::span<const double> spins() const { return side_columns()[SideColumn::spin]; }
    /// The radius and the mass of each disc. A copy shares the memory.
    const SpeciesTable& species_table() const;
    /// The present time in micro-steps since the last sync, for DiscState::x_at.
    double clock() const;
    /// The frame of the coordinates of `discs()` at `clock()`. It is the box's own
    /// unless there is gravity.
    Frame frame() const;
    /// The own discs as the box sees them at `clock()`. This is `discs()` itself
    /// unless there is gravity; else it is good until the next call.
    std::span<const DiscState> shown() const;
    /// The factor from stored velocities to velocities per step.
    double velocity_unit() const { return velocity_unit_; }

    /// From now on every collision is appended to `log` of one rank, in no particular order; null
    /// ends that.
    void log_to(std::vector<Collision>* log);

    /// From now on `follower` is given this rank's collisions of pairs, or with the sides of the
    /// box, during each call of `advance_towards`, until it is forgotten.
    void follow_pairs(PairFollower& follower);
    void forget(PairFollower& follower);
    void follow_walls(WallFollower& follower);
    void forget(WallFollower& follower);
    /// From now on the box lengths by which syncs in a periodic box bring own discs
    /// back are appended to `crossings`, until it is forgotten.
    void note_crossings_in(std::vector<Crossing>& crossings);
    void forget_crossings_in(std::vector<Crossing>& crossings);
    /// From now on `act` is called at each sync before effects act there; see Engine. An empty
    /// function ends that.
    void call_before_effects(std::function<void()> act);
    /// This rank's sums of stress since the simulation was made, up to the last sync and with all
    /// collisions since then, in the unit of `stress_bound()`.
    const StressSums& stress_sums() const;
    double stress_bound() const { return stress_bound_; }
    int n_threads() const { return n_threads_; }
    /// The sums from which averages follow, at present, without the integrals of
    /// stress and energy. **Collective.**
    MotionSample motion_sample() const;
    /// Adds these, where `mine` are this rank's sums of the time that counts. **Collective.**
    void integrate(const StressSums& mine, MotionSample& sample) const;
    /// Adds those over flights since the last sync alone, which are no part of the sums yet.
    void integrate_flights(MotionSample& sample) const;
    const AveragedSystem& averaged_system() const { return *averaged_system_; }
    /// Begins the sums anew in another unit, as a checkpoint's measurements need it; before any
    /// step.
    void begin_stress_sums(double bound);

    /// Adds to counts[k] this rank's pairs of discs at distances from k to k + 1 times `bin_width`,
    /// now; over all ranks each pair is counted once. The counts of all bins reach no further than
    /// half the box. `species_ends`: the ids before which species end, the last one the number of
    /// discs. As many counts follow each other for pairs of species (0, 0), (0, 1), (1, 1), (0, 2)
    /// and so on. **Collective.**
    void count_pair_distances(double bin_width, std::span<const DiscId> species_ends,
                              std::span<std::uint64_t> counts) const;

    /// psi6 of all discs together, and of their pairs up to that distance, of all ranks.
    /// **Collective.**
    HexaticSums hexatic_order(double largest_distance, std::size_t n_bins) const;
    /// psi6 of no more than `most_discs` discs, evenly spread over the ids, without pairs.
    /// **Collective.**
    HexaticSums sampled_order(std::uint64_t most_discs) const;
    /// psi6 of each of the own discs, along `discs()` as they lie then: this moves them in memory.
    /// **Collective.**
    std::vector<BondOrder> bond_orders() const;

    /// From now on every step is held to the invariants of check_failure.hpp: `advance_towards`
    /// goes one step at a time and throws CheckFailure on every rank when one is broken. `scene`
    /// must outlive the run, and be of the default precision and arithmetic. **Collective.**
    void check_every_step(const SceneParameters& scene);

    /// **Collective.**
    Totals totals() const;
    /// Number, energies and momentum alone, which takes two passes over the discs. **Collective.**
    Totals energies() const;
    RollbackCounts rollback_counts() const;
    /// See Engine::bytes_for_crowds.
    double bytes_for_crowds() const;
    PhaseSeconds phase_seconds() const;
    /// How many ranks share a strip, at most; the same on all ranks.
    int most_ranks_across() const;

private:
    void advance_checked();
    const SpeciesTable* table_if_mixed() const; ///< null if all discs are equal
    LocalView find_orders(double reach_beyond, std::uint64_t ids_apart,
                          std::vector<BondOrder>& orders) const;
    /// Like `shown()`, but only the velocities are right.
    std::span<const DiscState> in_motion() const;
    /// Like in_motion, without the mean flow between sheared sides, which is no temperature.
    std::span<const DiscState> in_flow() const;

    Communicator communicator_;
    double velocity_unit_, sync_interval_;
    Effects effects_; ///< times in steps
    SideColumnSet columns_;
    Box box_;
    int n_threads_;
    double heaviest_ = 1; ///< the largest mass of a disc
    double stress_bound_ = 1;
    std::unique_ptr<Engine> engine_;
    std::unique_ptr<const AveragedSystem> averaged_system_;
    std::unique_ptr<StressSums> stress_; ///< the engine adds to it
    std::unique_ptr<StateCheck> check_;
    mutable DiscStates shown_;              ///< under gravity
    mutable DiscStates stored_;             ///< once discs have left the box
    mutable SideColumns stored_columns_;    ///< once discs have left the box
    std::vector<Collision>* log_ = nullptr; ///< the user's log, while the check has its own
};

} // namespace carrom

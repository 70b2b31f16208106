// SPDX-License-Identifier: BSD-3-Clause
// The state of a run and how it moves forward in time. It opens no file and prints nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <carrom/averages.hpp>

#include "core/disc.hpp"
#include "core/frame.hpp"
#include "engine/collision.hpp"
#include "engine/stored_state.hpp"
#include "engine/totals.hpp"
#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

namespace carrom {

struct AveragedSystem;
class BlockAverages;
class Engine;
class StateCheck;
struct BondOrder;
struct HexaticSums;
struct LocalView;
struct Look;
struct StressSums;
struct WallImpulses;

class Simulation {
public:
    /// Takes over `discs` as the scene has them (velocities per step, tau 0), in any distribution
    /// over the ranks in any way.
    /// **Collective.**
    Simulation(const Scene& scene, std::vector<InputDisc> discs, const Communicator& communicator,
               const Tuning& tuning);
    /// Goes on from a stored state of the same scene, in any distribution over the ranks.
    /// **Collective.**
    Simulation(const Scene& scene, StoredState state, const Communicator& communicator,
               const Tuning& tuning);
    ~Simulation();

    /// Runs until `last_step`, or until an earlier step that is a good place to look up from (at
    /// least one step on). Steps are the scene's. **Collective.**
    void advance_towards(std::int64_t last_step);

    std::int64_t step() const;
    std::int64_t micro_steps_done() const;

    /// Own discs in no particular order: velocities per micro-step, times on `clock()`. Those that
    /// have left the box are among them (Disc::has_departed). Good until the next call.
    std::span<const Disc> discs() const;
    /// Along `discs()`. Good until the next call.
    SideSpans side_columns() const;
    /// One of them, in angles per micro-step; empty where discs are not rough.
    std::span<const double> spins() const { return side_columns()[SideColumn::spin]; }
    /// The present time in micro-steps since the last sync, to evaluate Disc::x_at with.
    double clock() const;
    /// What the coordinates of `discs()` are in at `clock()`; the box's own unless there is
    /// gravity.
    Frame frame() const;
    /// The own discs as the box sees them at `clock()`: `discs()` itself unless there is gravity,
    /// else good until the next call.
    std::span<const Disc> shown() const;
    /// What velocities are multiplied by to be per step.
    double velocity_unit() const { return velocity_unit_; }

    /// From now on every collision is appended to `log` of one rank, in no particular order; null
    /// ends that.
    void log_to(std::vector<Collision>* log);

    /// From now on what discs hand over to the sides of the box is added to `impulses` of one rank;
    /// null ends that.
    void add_impulses_to(WallImpulses* impulses);
    /// From now on what own discs are brought back by at syncs, in a periodic box, is appended to
    /// `crossings`, until it is forgotten.
    void note_crossings_in(std::vector<Crossing>& crossings);
    void forget_crossings_in(std::vector<Crossing>& crossings);
    /// This rank's sums of stress since the simulation was made, up to the last sync and with all
    /// collisions since then, in the unit of `stress_bound()`.
    const StressSums& stress_sums() const;
    double stress_bound() const { return stress_bound_; }
    int n_threads() const { return n_threads_; }
    /// What the averages follow from, now, but for the integrals of stress and energy.
    /// **Collective.**
    Look look() const;
    /// Adds these, where `mine` are this rank's sums of the time that counts. **Collective.**
    void integrate(const StressSums& mine, Look& look) const;
    const AveragedSystem& averaged_system() const;
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
    /// psi6 of each of the own discs, along `discs()` as they lie then: this moves them in memory.
    /// **Collective.**
    std::vector<BondOrder> bond_orders() const;

    /// From now on every step is held to the invariants of check_failure.hpp: `advance_towards`
    /// goes one step at a time and throws CheckFailure on every rank when one is broken. `scene`
    /// must outlive the run, and be of the default precision and arithmetic. **Collective.**
    void check_every_step(const Scene& scene);

    /// Averages since the run's start, or since `average_anew`. **Collective.**
    Averages averages() const;
    /// What `averages` and the sums of stress rest on, for a checkpoint; empty before they have
    /// begun.
    /// **Collective.**
    std::vector<std::int64_t> stored_averages() const;
    /// Goes on with those of a checkpoint of the present step, before any step. They begin anew
    /// where there are none, or where averages are to be over other steps.
    void go_on_averaging(std::span<const std::int64_t> words);
    /// Forgets what has been averaged so far, as before a gas had come to equilibrium.
    /// **Collective.**
    void average_anew();

    /// **Collective.**
    Totals totals() const;
    /// Number, energies and momentum alone: two passes over the discs. **Collective.**
    Totals energies() const;
    RollbackCounts rollback_counts() const;
    PhaseSeconds phase_seconds() const;

private:
    void advance_checked();
    LocalView find_orders(double reach_beyond, std::vector<BondOrder>& orders) const;
    Look integrated_look() const;
    /// As `shown()`, for whoever looks at velocities only.
    std::span<const Disc> in_motion() const;
    /// The same without the mean flow between sheared sides, which is no temperature.
    std::span<const Disc> in_flow() const;

    Communicator communicator_;
    double velocity_unit_;
    Effects effects_; ///< times in steps
    SideColumnSet columns_;
    Box box_;
    int n_threads_;
    double heaviest_ = 1; ///< mass of a disc
    double stress_bound_ = 1;
    std::int64_t averages_from_;
    std::unique_ptr<Engine> engine_;
    std::unique_ptr<BlockAverages> averages_;
    std::unique_ptr<StressSums> stress_; ///< the engine adds to it
    std::unique_ptr<StateCheck> check_;
    mutable std::vector<Disc> shown_;       ///< under gravity
    mutable std::vector<Disc> stored_;      ///< once discs have left
    mutable SideColumns stored_columns_;    ///< likewise
    std::vector<Collision>* log_ = nullptr; ///< the user's, while the check has a log of its own
};

} // namespace carrom

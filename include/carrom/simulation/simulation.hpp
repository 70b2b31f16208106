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

#include "carrom/core/disc.hpp"
#include "carrom/core/frame.hpp"
#include "carrom/core/state_hash.hpp"
#include "carrom/parallel/communicator.hpp"
#include "carrom/scene/scene.hpp"
#include "carrom/simulation/averages.hpp"

namespace carrom {

/// Choices that cost or save time and have no say in the bits. Unset ones are chosen from the scene as it runs.
struct Tuning {
    int threads = 1;
    std::uint64_t discs_per_thread = 2000; ///< a rank with fewer uses fewer threads
    std::optional<double> window;      ///< micro-steps per window; below 1 the micro-step is cut into parts
    std::optional<double> cell_width;  ///< in units of the window's reach
    std::optional<double> usual_speed; ///< in units of the largest: what cells allow for where a micro-step is cut
    std::int64_t rebalance_every = 1;  ///< in syncs; 0 keeps the first strips for ever
    double rebalance_above = 1.05;     ///< largest over mean load that is tolerated; 0 moves the cuts every time
};

/// What is known of a state; order-free, so the same bits for every machine shape. Energies in the scene's units.
struct Totals {
    std::uint64_t n_discs = 0;
    std::uint64_t wall_collisions = 0;
    std::uint64_t pair_collisions = 0;      ///< pairs, not discs
    std::uint64_t rejected_candidates = 0;  ///< since this process started stepping
    std::uint64_t overlapping_pairs = 0;    ///< now, deeper than the tolerance
    double deepest_overlap = 0;             ///< of these; 2 r where two discs are in one place
    std::uint64_t touching_pairs = 0;       ///< now, within the tolerance of contact
    std::uint64_t sliding_pairs = 0;        ///< of these: not even rounding tells whether they approach
    std::uint64_t chained_discs = 0;        ///< discs that touch two others or more
    double kinetic_energy = 0;              ///< of motion, not of spin
    double rotational_energy = 0;           ///< of rough discs
    double potential_energy = 0;            ///< under gravity, above the walls that it pulls to at the start
    double momentum_x = 0, momentum_y = 0;
    std::array<std::uint64_t, 4> gone{};    ///< discs that have left, by the side they left through
    StateHash hash;
};

/// How the run got on under the rule "all"; depends on the machine shape. Zero under "one".
struct ReplayCounts {
    std::uint64_t windows = 0, windows_redone = 0; ///< redone: in some block at least, on any rank
    std::uint64_t blocks = 0, blocks_redone = 0;   ///< replays of blocks on all ranks, first ones and repeated ones
};

/// Seconds this rank has spent, by phase, in the order they are reported.
using PhaseSeconds = std::vector<std::pair<std::string, double>>;

/// What a run can be continued from: discs as they are stored at the end of a step (velocities per micro-step, times
/// since the last sync), and how many micro-steps since the scene's start have led there.
struct StoredState {
    std::vector<Disc> discs;
    std::int64_t micro_steps_done = 0;
    std::vector<double> spins{}; ///< along the discs, of rough ones; empty: no disc turns yet
};

/// A collision that has happened. Order: micro_step, time, generation, p, wall before pair, q.
struct Collision {
    static constexpr DiscId wall = ~DiscId{0};

    std::int64_t micro_step = 0;  ///< that `time` counts from, since the scene's start
    double time = 0;              ///< in micro-steps
    std::uint64_t generation = 0; ///< orders chains that take no time under the rule "all"
    DiscId p = 0, q = wall;       ///< p is the lower id of a pair
    double impulse = 0;           ///< what p has got, in mass times length per step
};

/// A disc that has flown on through periodic sides has been brought into the box by so many box lengths.
struct Crossing {
    DiscId disc = 0;
    double x = 0, y = 0; ///< whole numbers
};

class BlockAverages;
class Engine;
class StateCheck;
struct WallImpulses;

class Simulation {
public:
    /// Takes over `discs` as the scene has them (velocities per step, tau 0), spread over the ranks in any way.
    /// **Collective.**
    Simulation(const Scene& scene, std::vector<InputDisc> discs, const Communicator& communicator, const Tuning& tuning);
    /// Goes on from a stored state of the same scene, spread over the ranks in any way. **Collective.**
    Simulation(const Scene& scene, StoredState state, const Communicator& communicator, const Tuning& tuning);
    ~Simulation();

    /// Runs until `last_step`, or until an earlier step that is a good place to look up from (at least one step on).
    /// Steps are the scene's. **Collective.**
    void advance_towards(std::int64_t last_step);

    std::int64_t step() const;
    std::int64_t micro_steps_done() const;

    /// Own discs in no particular order: velocities per micro-step, times on `clock()`. Those that have left the box are
    /// among them (Disc::gone). Good until the next call.
    std::span<const Disc> discs() const;
    /// Along `discs()`, in angles per micro-step; empty where discs are not rough.
    std::span<const double> spins() const;
    /// The present time in micro-steps since the last sync, to evaluate Disc::x_at with.
    double clock() const;
    /// What the coordinates of `discs()` are in at `clock()`; the box's own unless there is gravity.
    Frame frame() const;
    /// The own discs as the box sees them at `clock()`: `discs()` itself unless there is gravity, else good until the next call.
    std::span<const Disc> shown() const;
    /// What velocities are multiplied by to be per step.
    double velocity_unit() const { return velocity_unit_; }

    /// From now on every collision is appended to `log` of one rank, in no particular order; null ends that.
    void log_to(std::vector<Collision>* log);

    /// From now on what discs hand over to the sides of the box is added to `impulses` of one rank; null ends that.
    void add_impulses_to(WallImpulses* impulses);
    /// From now on what own discs are brought back by at syncs, in a periodic box, is appended to `crossings`; null ends that.
    void note_crossings_in(std::vector<Crossing>* crossings);
    /// Adds to counts[k] this rank's pairs of discs at distances from k to k + 1 times `bin_width`, now; over all ranks each
    /// pair is counted once. The counts of all bins reach no further than half the box. `class_ends`: the ids before which classes end, the
    /// last one the number of discs; as many counts follow each other for pairs of classes (0, 0), (0, 1), (1, 1), (0, 2) and so on. **Collective.**
    void count_pair_distances(double bin_width, std::span<const DiscId> class_ends, std::span<std::uint64_t> counts) const;

    /// From now on every step is held to the invariants of check_failure.hpp: `advance_towards` goes one step at a time and
    /// throws CheckFailure on every rank when one is broken. `scene` must outlive the run, and be of the default precision
    /// and arithmetic. **Collective.**
    void check_every_step(const Scene& scene);

    /// Averages since this process began, or since `average_anew`. **Collective.**
    Averages averages() const;
    /// Forgets what has been averaged so far, as before a gas had come to equilibrium. **Collective.**
    void average_anew();

    /// **Collective.**
    Totals totals() const;
    ReplayCounts replay_counts() const;
    PhaseSeconds phase_seconds() const;

private:
    void advance_checked();
    /// As `shown()`, for whoever looks at velocities only.
    std::span<const Disc> in_motion() const;

    Communicator communicator_;
    double velocity_unit_;
    Effects effects_;                 ///< times in steps
    double box_size_;
    int n_threads_;
    std::unique_ptr<Engine> engine_;
    std::unique_ptr<BlockAverages> averages_;
    std::unique_ptr<StateCheck> check_;
    mutable std::vector<Disc> shown_;  ///< under gravity
    mutable std::vector<Disc> stored_; ///< once discs have left
    mutable std::vector<double> stored_spins_;
    std::vector<Collision>* log_ = nullptr; ///< the user's, while the check has a log of its own
};

} // namespace carrom

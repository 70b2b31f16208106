// SPDX-License-Identifier: BSD-3-Clause
// All discs of a run and the engine that moves them forward in time. It opens no file and prints
// nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/disc_state.hpp"
#include "core/frame.hpp"
#include "engine/collision.hpp"
#include "engine/stored_state.hpp"
#include "engine/totals.hpp"
#include "engine/tuning.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

struct AveragedSystem;
class Engine;
class StateCheck;
struct StressSums;

class DiscSystem {
public:
    /// Begins with `discs`, the scene's discs at step 0 with velocities per step, in any
    /// distribution over the ranks. The velocities are converted to velocities per micro-step.
    /// **Collective.**
    DiscSystem(const SceneParameters& scene, std::vector<InputDisc> discs,
               const Communicator& communicator, const Tuning& tuning);
    /// Continues from a stored state of the same scene, in any distribution over the ranks.
    /// **Collective.**
    DiscSystem(const SceneParameters& scene, StoredState state, const Communicator& communicator,
               const Tuning& tuning);
    ~DiscSystem();

    /// Runs the scene to `last_step` or, if that is earlier, to the first step that ends at or
    /// after the next sync, because reading the state is fast there. Runs at least one step if
    /// `last_step` is later than `step()`. **Collective.**
    void advance_towards(std::int64_t last_step);

    std::int64_t step() const;
    std::int64_t micro_steps_done() const;

    /// Own discs in no particular order. Velocities are per micro-step, and each disc has a time of
    /// its own on the scale of `clock()`. Discs that have left the box are included
    /// (DiscState::has_departed). Valid until the next call of a member function.
    std::span<const DiscState> discs() const;
    /// The side columns (core/side_columns.hpp) of `discs()`, in the same order and valid as long.
    SideSpans side_columns() const;
    /// The spins, in radians per micro-step; empty if discs are not rough.
    std::span<const double> spins() const { return side_columns()[SideColumn::spin]; }
    /// The radius and the mass of each disc. A copy shares the memory.
    const SpeciesTable& species_table() const;
    /// The species table, or null if all discs are equal.
    const SpeciesTable* species_if_mixed() const;
    double heaviest() const { return heaviest_; } ///< the largest mass of a disc
    /// The time for DiscState::x_at: micro-steps since the last sync, or the clock of a moving
    /// frame.
    double clock() const;
    /// The frame (core/frame.hpp) of the coordinates of `discs()` at `clock()`. It differs
    /// from the box's frame if discs fall or the box is periodic.
    Frame frame() const;
    /// The own discs at `clock()` in the coordinates of the box. This is `discs()` itself if
    /// `frame()` is the box's frame, and otherwise a copy that is valid until the next call.
    std::span<const DiscState> shown() const;
    /// Like `shown()`, but only velocities are valid. The mean flow between sheared sides is
    /// subtracted, because it is not part of the temperature.
    std::span<const DiscState> in_flow() const;
    /// The factor from stored velocities to velocities per step.
    double velocity_unit() const { return velocity_unit_; }

    std::uint64_t n_discs() const; ///< number of discs on all ranks, departed ones included
    Extent box() const;            ///< extent of the box at the present step
    const Effects& effects() const { return effects_; } ///< times in steps
    const Communicator& ranks() const { return communicator_; }
    int n_threads() const { return n_threads_; }
    /// The engine, for code that follows collisions or makes measurements. Only `advance_towards`
    /// may advance it, and only `log_to` may set its log.
    Engine& engine() { return *engine_; }
    const Engine& engine() const { return *engine_; }

    /// From now on every collision is appended to `log` on one of the ranks, in no particular
    /// order. A null pointer ends the logging.
    void log_to(std::vector<Collision>* log);

    /// This rank's sums of stress since construction or `begin_stress_sums`; `stress_bound()`
    /// determines their unit. They contain all collisions but lack the latest flights, which are
    /// added only at some of the syncs (Engine::flight_integral).
    const StressSums& stress_sums() const;
    double stress_bound() const { return stress_bound_; }
    const AveragedSystem& averaged_system() const { return *averaged_system_; }
    /// Restarts the sums of stress with the bound of a checkpoint's sums, so that both have the
    /// same unit. Call it before any step.
    void begin_stress_sums(double bound);

    /// From now on the invariants of check_failure.hpp are checked after every step:
    /// `advance_towards` runs one step at a time, and throws CheckFailure on every rank if one of
    /// them is broken. `scene` must outlive the run, and have the default precision and arithmetic.
    /// **Collective.**
    void check_every_step(const SceneParameters& scene);

    /// **Collective.**
    Totals totals() const;
    /// Computes only the number, energies and momentum of the discs, in a few passes over them.
    /// **Collective.**
    Totals energies() const;

private:
    void advance_checked();
    /// Like `shown()`, but only the velocities are valid.
    std::span<const DiscState> in_motion() const;

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
    std::unique_ptr<StressSums> stress_; ///< sums to which the engine adds
    std::unique_ptr<StateCheck> check_;
    mutable DiscStates shown_;              ///< the result of `shown()` if it is not `discs()`
    mutable DiscStates stored_;             ///< the result of `discs()` if discs have left the box
    mutable SideColumns stored_columns_;    ///< side columns of `stored_`
    std::vector<Collision>* log_ = nullptr; ///< the user's log; the check has a log of its own
};

} // namespace carrom

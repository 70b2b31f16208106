// SPDX-License-Identifier: BSD-3-Clause
// The results of a finished run, for the summary and the report.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/device_facts.hpp"
#include "measure/order_watch.hpp"
#include "measure/sampler.hpp"
#include "parallel/communicator.hpp"
#include "run/run.hpp"
#include "scene/effects/effect.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The results of a finished run. Times and memory depend on the machine and are combined over all
/// ranks, as each comment says. The totals do not depend on the numbers of ranks and threads.
struct RunResult {
    Totals start, end;
    std::vector<EndNumber> end_numbers; ///< numbers of effects, and of simultaneous collisions
    std::int64_t first_step = 0, last_step = 0;
    std::optional<StopReason> stop_reason; ///< why the run ended before the scene's last step
    int ranks = 1;
    int ranks_across = 1;    ///< largest number of ranks that share a strip
    int threads = 1;         ///< threads of each rank; the largest number if ranks differ
    DeviceFacts device;      ///< the GPU; its name is empty if there was none
    double wall_seconds = 0; ///< time that the slowest rank spent on steps, without output
    Averages averages;       ///< averages over the run, including the parts before restarts
    std::vector<WatchedNumber> watched; ///< psi6 if discs are dense; energy if it can change
    std::vector<MeasuredTable> tables;  ///< the tables that the scene measures
    std::vector<std::string> doubts_of_tables;
    RollbackCounts runs;        ///< rollbacks of the event-driven method
    PhaseSeconds phase_seconds; ///< time of the slowest rank in each phase
    /// For each phase, the largest time of a rank divided by the mean of the ranks
    PhaseSeconds phase_imbalance;
    double imbalance = 1; ///< largest `busy_seconds` of a rank divided by the ranks' mean
    /// Radii at the end divided by the scene's radii: Engine::size
    double size = 1;
    double peak_bytes_per_disc = 0; ///< sum of the ranks' peak memory divided by number of discs
};

/// Fills in the state and averages at the end of the run. **Collective.**
void fill_end(RunResult& result, const Run& run);
/// Fills in times of the slowest rank, imbalances, and facts on the machine. **Collective.**
void fill_times(RunResult& result, const PhaseSeconds& mine, const Communicator& ranks);

/// The packing at the scene's last step, or at the step at which a condition ended the run.
double last_packing(const SceneParameters& scene, const RunResult& result);

/// `part / whole`, or 0 if `whole` is 0.
double ratio(double part, double whole);

double ns_per_disc_step(const RunResult& result);

/// Whether a phase is a rank's own work in steps. It is not if the rank waits for other ranks
/// (wait, exchange, conflicts), or if the phase is not part of the steps (set-up, output).
bool is_own_work(std::string_view phase);
/// The time that a rank has spent on its own work.
double busy_seconds(const PhaseSeconds& phases);

/// Change of the energy during the run, divided by the energy at its start.
double energy_drift(const RunResult& result);

/// Mean number of collisions of a disc per micro-step. The error of the time-stepped method grows
/// with this number.
double collisions_per_disc(const SceneParameters& scene, const RunResult& result);

/// Rejected candidates divided by all candidates; both are counted since this process began.
double rejected_share(const RunResult& result);

/// One line on averages and `watched` numbers that are still changing or whose errors rest on few
/// independent samples; empty if there are none.
std::string doubts_of_averages(const Averages& averages,
                               std::span<const WatchedNumber> watched = {});
/// The doubts about averages and about measured tables, in one line.
std::string doubts_of_run(const RunResult& result);

/// Estimates for a time-stepped run; docs/understanding/pressure.md has the formulas.
struct LostCollisions {
    double share = 0; ///< share of all collisions of pairs that the time-stepped method misses
    double pressure_error = 0; ///< relative error of the pressure; negative if too low
};
LostCollisions lost_collisions(const SceneParameters& scene, const RunResult& result);
/// A one-line warning if a run misses more than 1 % of the collisions of pairs, else empty.
std::string warning_of_lost_collisions(const SceneParameters& scene, const RunResult& result);

/// The energy that guarded collisions would have lost, divided by the energy that restitution would
/// have taken without the guard (dynamics/contact_guard.hpp). Contacts at rest are not included.
/// Both energies are summed since this process began.
double guarded_share(const RunResult& result);
/// A warning if `guarded_share` exceeds 0.01 because of the scene's contact time, else empty.
std::string warning_of_guarded_collisions(const SceneParameters& scene, const RunResult& result);

/// Mean number of overlap partners of a disc at the end: 2 (number of pairs) / (number of discs).
double overlapping_pairs_per_disc(const RunResult& result);
/// The depth of the deepest overlap at the end, in diameters of the scene's largest disc.
double deepest_overlap(const SceneParameters& scene, const RunResult& result);

} // namespace carrom

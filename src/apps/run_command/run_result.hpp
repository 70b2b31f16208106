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

/// A finished run. Times and numbers that depend on the machine shape are combined over all ranks,
/// as each member says. The totals are the same for every shape.
struct RunResult {
    Totals start, end;
    std::vector<EndNumber> end_numbers; ///< numbers at the end from the scene's effects
    std::int64_t first_step = 0, last_step = 0;
    std::optional<StopReason> stop_reason; ///< why the run ended before the scene's last step
    int ranks = 1;
    int ranks_across = 1;    ///< number of ranks that share a strip, at most
    int threads = 1;         ///< per rank; the largest if ranks differ
    DeviceFacts device;      ///< the GPU; its name is empty if there was none
    double wall_seconds = 0; ///< time of stepping on the slowest rank; files have their own phases
    Averages averages;       ///< averages over the run, restarts included
    std::vector<WatchedNumber> watched; ///< order and energy, unless they are conserved
    std::vector<MeasuredTable> tables;  ///< the tables that the scene measures
    std::vector<std::string> doubts_of_tables;
    RollbackCounts runs;        ///< rollbacks of the event-driven method
    PhaseSeconds phase_seconds; ///< time of the slowest rank in each phase
    /// For each phase the largest time of a rank relative to the mean
    PhaseSeconds phase_imbalance;
    double imbalance = 1; ///< the same ratio for `busy_seconds`
    /// Factor from the scene's radii to those at the end: Engine::size
    double size = 1;
    double peak_bytes_per_disc = 0; ///< the sum of the ranks' peaks, per disc
};

/// Fills in what the run has at its end. **Collective.**
void fill_end(RunResult& result, const Run& run);
/// Fills in times on the slowest rank, how even they are, and the machine. **Collective.**
void fill_times(RunResult& result, const PhaseSeconds& mine, const Communicator& ranks);

/// The packing at the scene's last step, or where a condition has ended the run.
double last_packing(const SceneParameters& scene, const RunResult& result);

/// `part / whole`, or 0 if `whole` is 0.
double ratio(double part, double whole);

double ns_per_disc_step(const RunResult& result);

/// Whether a phase is a rank's own work: it does not wait for other ranks in it (wait,
/// exchange, conflicts), and it is part of stepping (not set-up or output).
bool is_own_work(std::string_view phase);
/// The time that a rank has spent on its own work.
double busy_seconds(const PhaseSeconds& phases);

/// Change of the energy over the run, relative to its start.
double energy_drift(const RunResult& result);

/// Collisions of a disc per micro-step, on average. The error of the time-stepped
/// method grows with this number.
double collisions_per_disc(const SceneParameters& scene, const RunResult& result);

/// Candidates that were not carried out, of all candidates since this process began.
double rejected_share(const RunResult& result);

/// The reason why an average has no error; empty if it has one.
std::string reason_without_error(const Estimate& estimate, const Averages& averages);
/// One line on averages that are still changing, and on those whose errors rest on few
/// independent samples; empty if there are none. Numbers that are watched may be among them.
std::string doubts_of_averages(const Averages& averages,
                               std::span<const WatchedNumber> watched = {});
/// These doubts and those of measured tables, joined to one line.
std::string doubts_of_run(const RunResult& result);

/// An estimate of what a time-stepped run misses; docs/understanding/pressure.md has the formula.
struct LostCollisions {
    double share = 0; ///< share of all collisions of pairs that the time-stepped method misses
    double pressure_error = 0; ///< relative error; negative if the pressure is too low
};
LostCollisions lost_collisions(const SceneParameters& scene, const RunResult& result);
/// One line if a run misses more than a hundredth of the collisions of pairs, else empty.
std::string warning_of_lost_collisions(const SceneParameters& scene, const RunResult& result);

/// The energy that guarded collisions kept, as a share of what restitution would have taken. A
/// collision is guarded if one of its discs had collided within the contact time. Counts since this
/// process began.
double guarded_share(const RunResult& result);
/// A warning if `guarded_share` exceeds 0.01 because of the scene's contact time, else empty.
std::string warning_of_guarded_collisions(const SceneParameters& scene, const RunResult& result);

/// Number of overlapping pairs at the end, divided by the number of discs.
double overlapping_pairs_per_disc(const RunResult& result);
/// The deepest of these overlaps, in diameters of the scene's largest disc.
double deepest_overlap(const SceneParameters& scene, const RunResult& result);

} // namespace carrom

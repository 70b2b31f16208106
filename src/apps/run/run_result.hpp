// SPDX-License-Identifier: BSD-3-Clause
// What is known of a run when it is over: what summary and report both show.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "measure/sampler.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

/// A finished run. Numbers of machine shape and time are over all ranks; the totals are the same
/// for every shape.
struct RunResult {
    Totals start, end;
    std::int64_t first_step = 0, last_step = 0;
    int ranks = 1;
    int threads = 1;         ///< per rank; the largest where ranks differ
    double wall_seconds = 0; ///< of stepping, on the slowest rank; files are phases of their own
    Averages averages;       ///< over the run, restarts included
    std::vector<MeasuredTable> tables; ///< of what the scene asks to be measured
    RollbackCounts runs;               ///< in the event-driven method
    PhaseSeconds phase_seconds;        ///< each on the rank where it took longest
    PhaseSeconds phase_imbalance;      ///< that over the mean of all ranks
    double imbalance = 1;              ///< the same of `busy_seconds`
    double peak_bytes_per_disc = 0;    ///< peak memory of all ranks together, per disc
};

/// Takes what the simulation knows at its end. **Collective.**
void fill_end(RunResult& result, const Simulation& simulation);
/// Times as they are on the slowest rank, how even they are, and the machine. **Collective.**
void fill_times(RunResult& result, const PhaseSeconds& mine, const Communicator& ranks);

/// `part` of `whole`; 0 where there is no whole.
double ratio(double part, double whole);

double ns_per_disc_step(const RunResult& result);

/// Whether a phase is a rank's own work: not one in which it may wait for other ranks (wait,
/// exchange, conflicts) or is not stepping (set-up, output).
bool is_own_work(std::string_view phase);
/// What a rank has spent on its own work.
double busy_seconds(const PhaseSeconds& phases);

/// Change of the energy over the run, relative to its start.
double energy_drift(const RunResult& result);

/// Collisions that a disc takes part in per micro-step, on average: what the error of the
/// time-stepped method grows with.
double collisions_per_disc(const Scene& scene, const RunResult& result);

/// Candidates that were not carried out, of all candidates since this process began.
double rejected_share(const RunResult& result);

/// Why an average has no error; empty where it has one.
std::string reason_without_error(const Estimate& estimate, const Averages& averages);
/// One line on averages that are still changing, and on those whose errors rest on few independent
/// samples; empty where there are none.
std::string doubts_of_averages(const Averages& averages);

/// What a time-stepped run is estimated to miss; docs/understanding/pressure.md has the formula.
struct LostCollisions {
    double share = 0;          ///< of the collisions of pairs that the event-driven method finds
    double pressure_error = 0; ///< relative, negative where the pressure is too low
};
LostCollisions lost_collisions(const Scene& scene, const RunResult& result);
/// One line where more than a hundredth is lost, else empty.
std::string warning_of_lost_collisions(const Scene& scene, const RunResult& result);

/// Pairs at the end that a disc takes part in, on average.
double overlapping_pairs_per_disc(const RunResult& result);
/// Of these, in diameters of the scene's largest disc.
double deepest_overlap(const Scene& scene, const RunResult& result);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// What a run says of itself when it is over: a page for people, a JSON object for programs. Both
// show the same numbers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure/sampler.hpp"
#include "scene/scene.hpp"
#include "simulation/effect_costs.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

/// A finished run. Numbers of machine shape and time are over all ranks; the totals are the same
/// for every shape.
struct RunResult {
    Totals start, end;
    std::int64_t first_step = 0, last_step = 0;
    int ranks = 1;
    int threads = 1; ///< per rank; the largest where ranks differ
    double wall_seconds =
        0;             ///< spent stepping, on the slowest rank; reading and writing are phases
    Averages averages; ///< since this process began
    std::vector<MeasuredTable> tables;    ///< of what the scene asks to be measured
    std::vector<EffectCost> effect_costs; ///< as rank 0 has timed them
    RollbackCounts runs;                  ///< in the event-driven method
    PhaseSeconds phase_seconds;           ///< each on the rank where it took longest
    PhaseSeconds phase_imbalance;         ///< that over the mean of all ranks
    double imbalance = 1;                 ///< the same of `busy_seconds`
    double peak_bytes_per_disc = 0;       ///< peak memory of all ranks together, per disc
};

double ns_per_disc_step(const RunResult& result);

/// What a rank has spent stepping on work of its own: all phases but those in which it may wait for
/// other ranks (wait, exchange, contested) or is not stepping (set-up, output).
double busy_seconds(const PhaseSeconds& phases);

/// Change of the kinetic energy over the run, relative to its start.
double energy_drift(const RunResult& result);

/// Collisions that a disc takes part in per micro-step, on average: what the error of the
/// time-stepped method grows with.
double collisions_per_disc(const Scene& scene, const RunResult& result);

/// Candidates that were not carried out, of all candidates since this process began.
double rejected_share(const RunResult& result);

/// Lines of text, each ended.
std::string summary_text(const Scene& scene, const RunResult& result);

/// A JSON object; keys are described in docs/user.md.
std::string report_text(const Scene& scene, const RunResult& result);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The lines of the tables that `carrom accuracy` writes: one for each trial, or, of distances along
// time, one for each look.
#pragma once

#include <string>

#include "run/pilot/trial.hpp"

namespace carrom {

/// What a line begins with, unlike all others.
struct TrialKey {
    int start = 0; ///< number of the start, from 0
    RunSetting setting;
    TrialLength length;
    int repetition = 0; ///< the same trial again, for its cost
};

/// How far discs are from those of another run, in diameters.
struct Distance {
    double root_mean_square = 0, median = 0;
};

/// What became of a trial. `failure` says why it could not be run to its end, and there are no
/// numbers then. `distance` is that to the exact run at the early step.
struct TrialOutcome {
    Trial trial;
    Distance distance;
    std::string failure;
};

std::string costs_header();
std::string costs_line(const Scene& scene, const TrialStart& start, const TrialKey& key,
                       const TrialOutcome& outcome, int threads);

std::string distances_header();
/// `collisions` are those that a disc has had with others in the exact run until `step`.
std::string distances_line(const Scene& scene, const TrialStart& start, const TrialKey& key,
                           std::int64_t step, double collisions, const Distance& distance);

} // namespace carrom

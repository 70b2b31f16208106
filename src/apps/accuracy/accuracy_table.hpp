// SPDX-License-Identifier: BSD-3-Clause
// The lines of the tables of `carrom accuracy`: one line for each trial or, in the table of
// distances against time, one for each sample.
#pragma once

#include <string>

#include "run/pilot/trial.hpp"

namespace carrom {

/// The first columns of a line; no two lines of a table agree in all of them.
struct TrialKey {
    int start = 0; ///< number of the initial state, from 0
    RunSetting setting;
    TrialLength length;
    int repetition = 0; ///< number of the repetition, which measures the cost of a trial again
};

/// Distances between the positions of the same disc in two runs, over all discs, in diameters.
struct Distance {
    double root_mean_square = 0, median = 0;
};

/// The results of a trial. If it could not be run to its end, `failure` has the reason and there
/// are no numbers. `distance` is the distance to the exact run at TrialLength::early_step.
struct TrialOutcome {
    Trial trial;
    Distance distance;
    std::string failure;
};

std::string costs_header();
std::string costs_line(const SceneParameters& scene, const TrialStart& start, const TrialKey& key,
                       const TrialOutcome& outcome, int threads);

std::string distances_header();
/// `collisions`: mean number of collisions of a disc with others in the exact run up to `step`.
std::string distances_line(const SceneParameters& scene, const TrialStart& start,
                           const TrialKey& key, std::int64_t step, double collisions,
                           const Distance& distance);

} // namespace carrom

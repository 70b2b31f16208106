// SPDX-License-Identifier: BSD-3-Clause
// The lines of the tables that `carrom accuracy` writes: one for each trial in the table of costs,
// and one for each sample in the table of distances against time.
#pragma once

#include <string>

#include "run/pilot/trial.hpp"

namespace carrom {

/// The trial to which a line of a table belongs.
struct TrialKey {
    int start = 0; ///< number of the initial state, from 0
    RunSetting setting;
    TrialLength length;
    int repetition = 0; ///< number from 0; repetitions measure the cost of the same trial again
};

/// The distance between the positions of a disc in two runs: averages over all discs, in diameters.
struct Distance {
    double root_mean_square = 0, median = 0;
};

/// The results of a trial. If it could not be run to its end, `failure` is the reason, and the
/// other members are not set. `distance` compares the discs with those of the exact run at
/// TrialLength::early_step.
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

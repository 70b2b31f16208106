// SPDX-License-Identifier: BSD-3-Clause
// The two studies of `carrom accuracy`. One measures how settings change the collision rate, the
// pressure and the cost. The other measures how far discs depart from their positions in the exact
// run, which is event-driven. Both run every setting from the same initial states.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

enum class Formulas {
    usual,
    stable,
    all
}; ///< usual: stable formula, double precision; stable: + single precision; all: + naive formula

struct StudyOptions {
    std::string table = "accuracy.csv";
    int n_starts = 8, n_repetitions = 3, share = 1, n_shares = 1, threads = 1;
    double collisions = 100, approach = 20;
    std::int64_t most_micro_steps = 256;
    Formulas formulas = Formulas::all;
    bool quiet = false;
};

/// Measures costs and errors of K = 1, 2, 4, ... micro-steps per step in both methods. Each
/// repetition runs all settings one after the other. Throws InputError. Called on one rank.
void study_costs(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                 const StudyOptions& options, const Communicator& ranks);

/// Runs K = 1, 16, 256, ... micro-steps per step, and measures how far discs are from their
/// positions in the exact run, at intervals in which a disc collides about once. Throws InputError.
/// Called on one rank.
void study_distances(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                     const StudyOptions& options, const Communicator& ranks);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The two studies of `carrom accuracy`. One measures how settings change the collision rate, the
// pressure and the cost. The other measures how far discs move away from where they are in the
// exact run, which is event-driven. Both run every setting from equal initial states.
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
}; ///< usual: stable formula in double precision; stable: also in single precision; all: naive, too

struct StudyOptions {
    std::string table = "accuracy.csv";
    int n_starts = 8, n_repetitions = 3, share = 1, n_shares = 1, threads = 1;
    double collisions = 100, approach = 20;
    std::int64_t most_micro_steps = 256;
    Formulas formulas = Formulas::all;
    bool quiet = false;
};

/// Measures costs and errors of K = 1, 2, 4, ... micro-steps per step in both methods. A repetition
/// runs all settings in turn. Throws InputError. Called on one rank.
void study_costs(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                 const StudyOptions& options, const Communicator& ranks);

/// Measures distances of discs from their positions in the exact run, about once per collision of a
/// disc, with K = 1, 16, 256, ... micro-steps per step. Throws InputError. Called on one rank.
void study_distances(const SceneParameters& scene, const std::vector<InputDisc>& discs,
                     const StudyOptions& options, const Communicator& ranks);

} // namespace carrom

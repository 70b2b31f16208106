// SPDX-License-Identifier: BSD-3-Clause
// Short runs of a scene under other settings, from one and the same start: what the accuracy study
// and the choice of a setting by `time.accuracy` measure errors and costs with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parallel/communicator.hpp"
#include "scene/scene.hpp"
#include "simulation/advance.hpp"
#include "simulation/simulation.hpp"

namespace carrom {

/// One way to run a scene.
struct RunSetting {
    Method method = Method::time_stepped;
    std::int64_t micro_steps = 1;
    Precision precision = Precision::double_;
    Arithmetic arithmetic = Arithmetic::stable;
    bool contraction = false;

    friend bool operator==(const RunSetting&, const RunSetting&) = default;
};

/// The scene with that setting.
Scene with_setting(Scene scene, const RunSetting& setting);

/// Discs that have been brought to equilibrium by the event-driven method, where a trial starts.
struct TrialStart {
    std::vector<InputDisc> discs; ///< this rank's
    StateHash hash;
    double frequency = 0; ///< collisions with other discs per disc and step
};

/// Runs `discs` under the event-driven method until a disc has had `collisions_per_disc` with
/// others, on average. Throws InputError where discs overlap, or where they hardly meet.
/// **Collective.**
TrialStart bring_to_equilibrium(const Scene& scene, std::vector<InputDisc> discs,
                                double collisions_per_disc, const Communicator& communicator,
                                const Tuning& tuning);

/// What a trial has measured. Energies, lengths and times in the scene's units.
struct Trial {
    std::int64_t steps = 0;
    Averages averages;
    Totals totals;                         ///< at its end
    double overlapping_pairs_per_disc = 0; ///< that a disc takes part in; mean over the looks
    double deepest_overlap = 0;            ///< of all looks, in diameters
    double core_seconds = 0;               ///< of stepping, over all ranks and threads
    double wall_seconds = 0;               ///< of stepping, on the slowest rank
    std::vector<InputDisc> early; ///< this rank's discs at `early_step`, by id; empty if it is 0
};

/// This rank's discs as they are now, by id, in the scene's units.
std::vector<InputDisc> discs_now(const Simulation& simulation);

struct TrialLength {
    std::int64_t steps = 1;
    std::int64_t early_step = 0; ///< where places are kept, 0 for nowhere
    int n_looks = 16;            ///< at overlaps
};

/// **Collective.**
Trial run_trial(const Scene& scene, const RunSetting& setting, const TrialStart& start,
                const TrialLength& length, const Communicator& communicator, const Tuning& tuning);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Short runs of a scene with other settings, from the same start. The accuracy study and the choice
// of a setting by `time.accuracy` measure errors and costs with them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <carrom/averages.hpp>

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

/// The settings of a scene that trials change.
struct RunSetting {
    Method method = Method::time_stepped;
    std::int64_t micro_steps = 1;
    Precision precision = Precision::double_;
    Arithmetic arithmetic = Arithmetic::stable;
    bool contraction = false;

    friend bool operator==(const RunSetting&, const RunSetting&) = default;
};

/// The scene with this setting, and without `time.accuracy`.
SceneParameters with_setting(SceneParameters scene, const RunSetting& setting);

/// Discs from which trials start, after the event-driven method has brought them to equilibrium.
struct TrialStart {
    std::vector<InputDisc> discs; ///< discs of this rank
    StateHash hash;
    double frequency = 0; ///< collisions with other discs per disc and step
};

/// Runs `discs` by the event-driven method until each disc has collided `collisions_per_disc` times
/// with others, on average. Throws InputError if discs overlap or hardly collide. **Collective.**
TrialStart bring_to_equilibrium(const SceneParameters& scene, std::vector<InputDisc> discs,
                                double collisions_per_disc, const Communicator& communicator,
                                const Tuning& tuning);

/// The results of a trial. Energies, lengths and times are in the scene's units.
struct Trial {
    std::int64_t steps = 0;
    Averages averages;
    Totals totals;                         ///< totals at the trial's end
    double overlapping_pairs_per_disc = 0; ///< overlaps of a disc at one time, mean over samples
    double deepest_overlap = 0;            ///< deepest overlap of all samples, in diameters
    double core_seconds = 0;               ///< CPU time of the steps, summed over ranks and threads
    double wall_seconds = 0;               ///< wall time of the steps on the slowest rank
    /// Discs of this rank at `early_step`, sorted by id; empty if `early_step` is 0
    std::vector<InputDisc> early;
};

/// This rank's discs at the system's present time, sorted by id, in the scene's units.
std::vector<InputDisc> discs_now(const DiscSystem& system);

struct TrialLength {
    std::int64_t steps = 1;
    std::int64_t early_step = 0; ///< the step of the discs in Trial::early; 0: none
    int n_samples = 16;          ///< number of samples of overlaps
};

/// Runs one trial from `start` and measures its collisions, overlaps and time. **Collective.**
Trial run_trial(const SceneParameters& scene, const RunSetting& setting, const TrialStart& start,
                const TrialLength& length, const Communicator& communicator, const Tuning& tuning);

} // namespace carrom

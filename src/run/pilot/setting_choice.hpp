// SPDX-License-Identifier: BSD-3-Clause
// `time.accuracy = x` chooses the fastest setting whose collision rate and pressure have relative
// errors of at most x.
//
// A pilot brings the scene's discs to equilibrium and runs them by the event-driven method. Then it
// tries the time-stepped method with K = 1, 2, 4, ... micro-steps, until a K is accurate enough, or
// two in succession are as slow as the event-driven method. Cost mostly grows with K, so the first
// accurate K is taken as the fastest. It has to be accurate after 100 collisions per disc; in dense
// gases errors may grow later. Single precision and the naive formula save almost no time
// (docs/understanding/accuracy.md).
#pragma once

#include <vector>

#include "run/messages.hpp"
#include "run/pilot/trial.hpp"

namespace carrom {

/// Chooses the scene's method and micro-steps, reports them in a message, and replaces
/// `time.accuracy` by them, so that checkpoints contain the choice. The choice depends on measured
/// times, so it may differ on another machine. Throws InputError if discs overlap or hardly
/// collide. **Collective.**
void choose_setting(SceneParameters& scene, const std::vector<InputDisc>& discs,
                    const Messages& messages, const Communicator& communicator,
                    const Tuning& tuning);

/// Writes the setting into the scene, in place of `time.accuracy`.
void decide_on(SceneParameters& scene, const RunSetting& setting);

/// The difference between the results of a trial and of the exact run.
struct TrialError {
    double frequency = 0, pressure = 0; ///< relative differences
    double error = 0;                   ///< a bound for the standard error of either

    double largest() const;
};
TrialError error_of(const Trial& trial, const Trial& exact);

} // namespace carrom

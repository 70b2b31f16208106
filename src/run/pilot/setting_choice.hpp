// SPDX-License-Identifier: BSD-3-Clause
// `time.accuracy = x` chooses the cheapest setting whose collision rate and pressure
// are within a share x of the truth.
//
// A pilot brings the scene's discs to equilibrium, runs them under the event-driven
// method, and then in the time-stepped method with K = 1, 2, 4, ... micro-steps, until
// a K is good enough or two in succession are as slow as the event-driven method. Cost
// grows with K, so the first good one is the cheapest. It must be good after 100
// collisions of a disc, and not become worse, as in dense gases. Single precision and
// the naive formula save next to no time (docs/understanding/accuracy.md).
#pragma once

#include <vector>

#include "run/messages.hpp"
#include "run/pilot/trial.hpp"

namespace carrom {

/// Chooses the scene's method and micro-steps, reports them in a message, and writes
/// them over `time.accuracy`, so that checkpoints hold the choice. It rests on
/// measured times, so it may differ on another machine. Throws InputError if discs
/// overlap or hardly meet. **Collective.**
void choose_setting(SceneParameters& scene, const std::vector<InputDisc>& discs,
                    const Messages& messages, const Communicator& communicator,
                    const Tuning& tuning);

/// Sets the setting in the scene, in place of `time.accuracy`.
void decide_on(SceneParameters& scene, const RunSetting& setting);

/// The difference between a trial and the exact one.
struct TrialError {
    double frequency = 0, pressure = 0; ///< relative
    double error = 0;                   ///< the larger of both standard errors

    double largest() const;
};
TrialError error_of(const Trial& trial, const Trial& exact);

} // namespace carrom

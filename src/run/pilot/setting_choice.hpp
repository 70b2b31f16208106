// SPDX-License-Identifier: BSD-3-Clause
// `time.accuracy = x`: the cheapest setting whose collision rate and pressure are within a share x
// of the truth.
//
// A pilot brings the scene's discs to equilibrium, runs them under the event-driven method, and
// then in the time-stepped method with K = 1, 2, 4, ... micro-steps, until one is good enough or
// two in succession are as expensive as the event-driven method. Cost grows with K, so the first
// good one is the cheapest. Good enough is what is so after 100 collisions of a disc, and does not
// become worse, as in dense gases. Single precision and the naive formula save next to no time
// (docs/understanding/accuracy.md).
#pragma once

#include <vector>

#include "run/messages.hpp"
#include "run/pilot/trial.hpp"

namespace carrom {

/// Chooses the scene's rule and micro-steps, says so in a message, and
/// writes them over `time.accuracy`, so that checkpoints hold the choice. It rests on measured
/// times: on another machine it may be another one. Throws InputError where discs overlap or hardly
/// meet. **Collective.**
void choose_setting(Scene& scene, const std::vector<InputDisc>& discs, const Messages& messages,
                    const Communicator& communicator, const Tuning& tuning);

/// Gives the scene that setting in the place of `time.accuracy`.
void decide_on(Scene& scene, const RunSetting& setting);

/// How far a trial is from the exact one.
struct TrialError {
    double frequency = 0, pressure = 0; ///< relative
    double error = 0;                   ///< one standard error of either, at most

    double largest() const;
};
TrialError error_of(const Trial& trial, const Trial& exact);

} // namespace carrom

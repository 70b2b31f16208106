// SPDX-License-Identifier: BSD-3-Clause
// The loop of every run: it advances to a given step, and calls actions between steps.
#pragma once

#include <cstdint>
#include <span>

#include "simulation/disc_system.hpp"

namespace carrom {

/// An action between the steps of a run, such as writing lines of text, files or checkpoints.
class StepAction {
public:
    virtual ~StepAction() = default;

    /// The first step after `step` that the run must not pass without calling `act`.
    virtual std::int64_t next_due(std::int64_t step) const = 0;
    /// Called after each stretch of steps, even if the action is not due. Returns false if the run
    /// must end here. **Collective.**
    virtual bool act() = 0;
    /// Makes all output so far permanent. Called before a checkpoint is written, because a restart
    /// from the checkpoint cannot repeat earlier output. **Collective.**
    virtual void commit() {}
};

/// Seconds that this rank has spent in the steps of a run, and in the actions between steps.
struct StretchSeconds {
    double steps = 0, actions = 0;
};

/// Advances to the end of `last_step`, and calls the actions in their order after each stretch of
/// steps. Returns false if an action ended the run early. **Collective.**
bool advance_to(DiscSystem& system, std::int64_t last_step,
                std::span<StepAction* const> actions = {}, StretchSeconds* seconds = nullptr);

} // namespace carrom

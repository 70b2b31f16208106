// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/advance.hpp"

#include <algorithm>

#include "core/stopwatch.hpp"

namespace carrom {

bool advance_to(DiscSystem& system, std::int64_t last_step, std::span<StepAction* const> actions,
                StretchSeconds* seconds) {
    StretchSeconds unused;
    StretchSeconds& spent = seconds ? *seconds : unused;
    Stopwatch watch;
    while (system.step() < last_step) {
        std::int64_t next = last_step;
        for (const StepAction* action : actions)
            next = std::min(next, action->next_due(system.step()));
        system.advance_towards(next);
        spent.steps += watch.lap();
        bool goes_on = true;
        for (StepAction* action : actions) goes_on = action->act() && goes_on;
        spent.actions += watch.lap();
        if (!goes_on) return system.step() >= last_step;
    }
    return true;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The end of a run whose growing discs have no room any more.
#pragma once

#include <cstdint>
#include <string>

#include "core/errors.hpp"

namespace carrom {

/// Thrown on every rank where growing discs jam. What was under way is in no consistent state then.
/// Exit code 3.
class Jammed : public CollectiveError {
public:
    Jammed(const std::string& text, std::int64_t safe_micro_step)
        : CollectiveError(text, ExitCode::collective_failure), safe_micro_step_(safe_micro_step) {}

    /// The run comes to the end of this micro-step without a jam. The same on all ranks.
    std::int64_t safe_micro_step() const { return safe_micro_step_; }

private:
    std::int64_t safe_micro_step_;
};

} // namespace carrom

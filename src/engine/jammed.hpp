// SPDX-License-Identifier: BSD-3-Clause
// Ends a run in which growing discs have no room left.
#pragma once

#include <cstdint>
#include <string>

#include "core/errors.hpp"

namespace carrom {

/// Thrown on every rank if growing discs jam. The state is then inconsistent and must not be used.
/// The program ends with exit code 3.
class Jammed : public CollectiveError {
public:
    Jammed(const std::string& text, std::int64_t safe_micro_step)
        : CollectiveError(text, ExitCode::collective_failure), safe_micro_step_(safe_micro_step) {}

    /// The run can be repeated up to the end of this micro-step without a jam. It is equal
    /// on all ranks.
    std::int64_t safe_micro_step() const { return safe_micro_step_; }

private:
    std::int64_t safe_micro_step_;
};

} // namespace carrom

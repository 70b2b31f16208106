// SPDX-License-Identifier: BSD-3-Clause
// Measures wall-clock time between calls.
#pragma once

#include <chrono>
#include <utility>

namespace carrom {

class Stopwatch {
public:
    /// Returns the seconds since the previous call, or, at the first call, since construction.
    double lap() {
        const auto now = Clock::now();
        return std::chrono::duration<double>(now - std::exchange(lap_start_, now)).count();
    }

private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point lap_start_ = Clock::now();
};

} // namespace carrom

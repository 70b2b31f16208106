// SPDX-License-Identifier: BSD-3-Clause
// Measures wall-clock time between calls.
#pragma once

#include <chrono>
#include <utility>

namespace carrom {

class Stopwatch {
public:
    /// Returns the seconds since the last call, or since the stopwatch was made.
    double lap() {
        const auto now = Clock::now();
        return std::chrono::duration<double>(now - std::exchange(lap_start_, now)).count();
    }

private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point lap_start_ = Clock::now();
};

} // namespace carrom

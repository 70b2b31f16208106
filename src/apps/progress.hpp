// SPDX-License-Identifier: BSD-3-Clause
// How far a run is, on standard error: one line rewritten on a terminal, a line now and then in a
// batch log.
//
// Lines in a log come at growing intervals, so a week-long run leaves some hundred of them. Under
// mpirun standard error is a pipe even at a terminal, so there it is lines too.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace carrom {

class Progress {
public:
    /// Shows nothing unless `wanted`: the caller decides which rank talks.
    Progress(std::int64_t first_step, std::int64_t last_step, bool wanted);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// To be called as often as one likes; prints when it is time to.
    void show(std::int64_t step);

    /// Leaves the cursor on an empty line.
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    std::int64_t first_step_, last_step_;
    bool wanted_, on_terminal_, line_is_open_ = false;
    Clock::time_point start_, due_;
    std::chrono::duration<double> interval_;
};

/// "step 120 of 1000 (12.0 %), 345 steps/s, 0:02:33 left"
std::string progress_text(std::int64_t step, std::int64_t first_step, std::int64_t last_step,
                          double seconds);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The progress of a run on standard error. On a terminal one line is rewritten; a batch log gets a
// new line at each print.
//
// The intervals between lines in a log grow to half an hour, so that a run of a week prints about
// 350 lines. Under mpirun standard error is a pipe even at a terminal, so the lines are printed as
// in a log.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace carrom {

class StatusLine {
public:
    /// Prints nothing unless `wanted`; the caller decides which rank prints.
    explicit StatusLine(bool wanted);
    ~StatusLine() { finish(); }
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;

    /// Whether enough time has passed to print again.
    bool is_due() const { return wanted_ && Clock::now() >= due_; }
    void show(const std::string& text);
    /// Ends the rewritten line, so that the next output starts on a line of its own.
    void finish();
    /// Seconds since this object was constructed.
    double seconds() const;

private:
    using Clock = std::chrono::steady_clock;

    bool wanted_, on_terminal_, line_is_open_ = false;
    Clock::time_point start_, due_;
    std::chrono::duration<double> interval_;
};

/// The progress of a run.
class Progress {
public:
    Progress(std::int64_t first_step, std::int64_t last_step, bool wanted)
        : first_step_(first_step), last_step_(last_step), line_(wanted) {}

    /// Prints if enough time has passed since the last print; call it after each step.
    void show(std::int64_t step);
    /// Ends the rewritten line, so that the next output starts on a line of its own.
    void finish() { line_.finish(); }

private:
    std::int64_t first_step_, last_step_;
    StatusLine line_;
};

/// Text such as "step 120 of 1000 (12.0 %), 345 steps/s, 0:02:33 left".
std::string progress_text(std::int64_t step, std::int64_t first_step, std::int64_t last_step,
                          double seconds);
/// Text such as "0:02:33".
std::string time_text(double seconds);

} // namespace carrom

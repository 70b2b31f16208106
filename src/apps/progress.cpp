// SPDX-License-Identifier: BSD-3-Clause
#include "apps/progress.hpp"

#include <algorithm>
#include <cstdio>

#include "apps/standard_streams.hpp"
#include <fmt/format.h>
#include <unistd.h>

namespace carrom {

namespace {

constexpr double terminal_interval = 0.2; // seconds: steady to the eye, nothing to the run
constexpr double first_log_interval = 5;
constexpr double longest_log_interval = 1800;
constexpr double log_growth = 1.5;

} // namespace

std::string progress_text(std::int64_t step, std::int64_t first_step, std::int64_t last_step,
                          double seconds) {
    const double done = static_cast<double>(step - first_step);
    const double all = static_cast<double>(std::max<std::int64_t>(last_step - first_step, 1));
    const double rate = done / std::max(seconds, 1e-9);
    std::string text = fmt::format("step {} of {} ({:.1f} %), {:.3g} steps/s", step, last_step,
                                   100 * done / all, rate);
    if (rate > 0) {
        const auto left = static_cast<std::int64_t>(static_cast<double>(last_step - step) / rate +
                                                    0.5);
        text += fmt::format(", {}:{:02}:{:02} left", left / 3600, left / 60 % 60, left % 60);
    }
    return text;
}

Progress::Progress(std::int64_t first_step, std::int64_t last_step, bool wanted)
    : first_step_(first_step), last_step_(last_step), wanted_(wanted),
      on_terminal_(isatty(STDERR_FILENO) == 1), start_(Clock::now()),
      interval_(on_terminal_ ? terminal_interval : first_log_interval) {
    due_ = start_ + std::chrono::duration_cast<Clock::duration>(interval_);
}

Progress::~Progress() { finish(); }

void Progress::show(std::int64_t step) {
    const auto now = Clock::now();
    if (!wanted_ || now < due_) return;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const std::string text = progress_text(step, first_step_, last_step_, seconds);
    if (on_terminal_) {
        print_message("\r{}\x1b[K", text); // erases what a longer line before has left
        line_is_open_ = true;
    } else {
        print_message("{}\n", text);
        interval_ = std::min(interval_ * log_growth,
                             std::chrono::duration<double>(longest_log_interval));
    }
    std::fflush(stderr);
    due_ = now + std::chrono::duration_cast<Clock::duration>(interval_);
}

void Progress::finish() {
    if (line_is_open_) print_message("\n");
    line_is_open_ = false;
}

} // namespace carrom

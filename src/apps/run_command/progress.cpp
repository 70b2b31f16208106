// SPDX-License-Identifier: BSD-3-Clause
#include "apps/run_command/progress.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "apps/shell/standard_streams.hpp"

namespace carrom {

namespace {

// Seconds between two prints on a terminal: progress seems continuous, and prints cost little.
constexpr double terminal_interval = 0.2;
constexpr double first_log_interval = 5;
constexpr double longest_log_interval = 1800;
constexpr double log_factor = 1.5;

} // namespace

StatusLine::StatusLine(bool wanted)
    : wanted_(wanted), on_terminal_(has_terminal()), start_(Clock::now()),
      interval_(on_terminal_ ? terminal_interval : first_log_interval) {
    due_ = start_ + std::chrono::duration_cast<Clock::duration>(interval_);
}

void StatusLine::show(const std::string& text) {
    if (on_terminal_) {
        rewrite_line(text);
        line_is_open_ = true;
    } else {
        print_message("{}\n", text);
        interval_ = std::min(interval_ * log_factor,
                             std::chrono::duration<double>(longest_log_interval));
    }
    due_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(interval_);
}

void StatusLine::finish() {
    if (line_is_open_) print_text("\n");
    line_is_open_ = false;
}

double StatusLine::seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::show(std::int64_t step) {
    if (line_.is_due()) line_.show(progress_text(step, first_step_, last_step_, line_.seconds()));
}

std::string progress_text(std::int64_t step, std::int64_t first_step, std::int64_t last_step,
                          double seconds) {
    const double done = static_cast<double>(step - first_step);
    const double all = static_cast<double>(std::max<std::int64_t>(last_step - first_step, 1));
    const double rate = done / std::max(seconds, 1e-9);
    std::string text = fmt::format("step {} of {} ({:.1f} %), {:.3g} steps/s", step, last_step,
                                   100 * done / all, rate);
    if (rate > 0) text += ", " + time_text(static_cast<double>(last_step - step) / rate) + " left";
    return text;
}

std::string time_text(double seconds) {
    const auto whole = static_cast<std::int64_t>(seconds + 0.5);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

} // namespace carrom

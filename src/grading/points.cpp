// SPDX-License-Identifier: BSD-3-Clause
#include "grading/points.hpp"

#include <fmt/format.h>

namespace carrom {

namespace {

constexpr int for_lines = 10, for_start = 10, for_steps = 60, for_counters = 20;

} // namespace

std::string Points::text() const {
    const int lines = are_lines_whole ? for_lines : 0;
    const int start = is_start_right ? for_start : 0;
    // Rounded down, so that only a program without a mistake gets all points.
    const int steps = n_graded == 0 ? 0 : static_cast<int>(for_steps * n_right / n_graded);
    const int counters = are_counters_right ? for_counters : 0;
    return fmt::format("points: {} of {}\n"
                       "  lines    {:2} of {}\n"
                       "  start    {:2} of {}\n"
                       "  steps    {:2} of {}: {} of {} graded steps follow from the step before\n"
                       "  counters {:2} of {}\n",
                       lines + start + steps + counters,
                       for_lines + for_start + for_steps + for_counters, lines, for_lines, start,
                       for_start, steps, for_steps, n_right, n_graded, counters, for_counters);
}

} // namespace carrom

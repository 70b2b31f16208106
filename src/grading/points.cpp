// SPDX-License-Identifier: BSD-3-Clause
#include "grading/points.hpp"

#include <fmt/format.h>

namespace carrom {

namespace {

constexpr std::int64_t for_lines = 10, for_order = 5, for_start = 10, for_steps = 60,
                       for_counters = 20;

struct Sum {
    std::int64_t points = 0, most = 0;
    std::string parts;

    void add(const char* name, std::int64_t some, std::int64_t of, const std::string& why = {}) {
        points += some;
        most += of;
        parts += fmt::format("  {:<8} {:2} of {}{}\n", name, some, of, why);
    }
    void leave_out(const char* name) { parts += fmt::format("  {:<8}  -: not shown\n", name); }
    void add(const char* name, std::optional<bool> is_right, std::int64_t of) {
        if (!is_right) return leave_out(name);
        add(name, *is_right ? of : 0, of);
    }
};

} // namespace

std::string Points::text() const {
    Sum sum;
    if (are_lines_whole && !are_in_order)
        sum.add("lines", for_lines - for_order, for_lines, ": discs are not in the order of ids");
    else
        sum.add("lines", are_lines_whole ? for_lines : 0, for_lines);
    sum.add("start", is_start_right, for_start);
    const std::int64_t n_steps = n_graded + n_missing;
    if (n_steps == 0)
        sum.leave_out("steps");
    else // rounded down, so that only a program without mistakes gets all points
        sum.add("steps", for_steps * n_right / n_steps, for_steps,
                fmt::format(": {} of {} steps follow from the step before{}", n_right, n_steps,
                            n_missing > 0 ? fmt::format(", {} missing", n_missing) : ""));
    sum.add("counters", are_counters_right, for_counters);
    return fmt::format("points: {} of {}\n{}", sum.points, sum.most, sum.parts);
}

} // namespace carrom

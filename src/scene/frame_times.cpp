// SPDX-License-Identifier: BSD-3-Clause
#include "scene/frame_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/limits.hpp"

namespace carrom {

namespace {

/// The step of frame k, rounded. Before rounding it is whole or irrational, so it is never halfway
/// between two whole numbers, and all machines round it alike.
double growing_step(const TrajectoryOutput& output, std::int64_t k) {
    return std::round(
        static_cast<double>(output.every_steps) *
        std::pow(10.0, static_cast<double>(k) / static_cast<double>(output.frames_per_decade)));
}

/// The first frame k whose step is later than `step`; `step` must be at least `every_steps`.
std::int64_t first_beyond(const TrajectoryOutput& output, std::int64_t step) {
    const double decades = std::log10(static_cast<double>(step) /
                                      static_cast<double>(output.every_steps));
    auto k = static_cast<std::int64_t>(
        std::max(0.0, decades * static_cast<double>(output.frames_per_decade) - 1));
    while (growing_step(output, k) <= static_cast<double>(step)) ++k;
    return k;
}

} // namespace

std::int64_t next_frame(const TrajectoryOutput& output, std::int64_t step) {
    if (output.frames_per_decade == 0) return (step / output.every_steps + 1) * output.every_steps;
    if (step < output.every_steps) return output.every_steps;
    const double next = growing_step(output, first_beyond(output, step));
    return next > static_cast<double>(largest_steps) ? std::numeric_limits<std::int64_t>::max()
                                                     : static_cast<std::int64_t>(next);
}

std::int64_t last_frame(const TrajectoryOutput& output, std::int64_t step) {
    if (output.frames_per_decade == 0) return step / output.every_steps * output.every_steps;
    if (step < output.every_steps) return 0;
    return static_cast<std::int64_t>(growing_step(output, first_beyond(output, step) - 1));
}

} // namespace carrom

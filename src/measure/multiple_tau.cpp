// SPDX-License-Identifier: BSD-3-Clause
#include "measure/multiple_tau.hpp"

#include <string>

#include <fmt/format.h>

namespace carrom {

Key correlation_points_key() {
    return correlation_points
        .integer("samples", "Lags of the first level of \"correlations\" and \"transport\": 4, 8, "
                            "16, 32 or 64.")
        .within({4, 64});
}

void check_correlation_points(const SceneDraft& draft) {
    const auto points = static_cast<std::uint64_t>(
        correlation_points.of(*draft.scene.measurements));
    if (!std::has_single_bit(points))
        draft.refuse({correlation_points.key_name(), quantities_key},
                     fmt::format("'{}' must be 4, 8, 16, 32 or 64, not {}",
                                 correlation_points.key_name(), points));
}

void warn_without_lags(const SceneDraft& draft) {
    const MeasurementOutput& output = *draft.scene.measurements;
    const std::int64_t steps = draft.scene.steps - output.from_step;
    if (draft.scene.steps == 0 || steps < 0 || steps >= output.every_steps) return;
    const std::string remedy = steps > 0
                                   ? fmt::format("output.measurements.every_steps = {} or less",
                                                 steps)
                                   : "a smaller output.measurements.from_step";
    draft.scene.warnings.push_back(
        fmt::format("no lags of \"correlations\" and \"transport\": the shortest one takes {} "
                    "steps, and from step {} to the last one are {}; try: {}",
                    output.every_steps, output.from_step, steps, remedy));
}

} // namespace carrom

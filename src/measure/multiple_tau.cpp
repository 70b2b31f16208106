// SPDX-License-Identifier: BSD-3-Clause
#include "measure/multiple_tau.hpp"

#include <fmt/format.h>

namespace carrom {

Key correlation_points_key() {
    return correlation_points
        .integer("samples", "Lags of the first level of \"correlations\" and \"transport\": 4, 8, "
                            "16, 32 or 64.")
        .within({4, 64});
}

void check_correlation_points(const Check& check) {
    const auto points = static_cast<std::uint64_t>(
        correlation_points.of(*check.scene.measurements));
    if (!std::has_single_bit(points))
        check.refuse({correlation_points.key_name(), quantities_key},
                     fmt::format("'{}' must be 4, 8, 16, 32 or 64, not {}",
                                 correlation_points.key_name(), points));
}

} // namespace carrom

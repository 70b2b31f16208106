// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <fmt/format.h>

#include <carrom/averages.hpp>

#include "measure/block_averages.hpp"

namespace carrom {

std::string reason_without_error(const Estimate& estimate, const Averages& averages) {
    if (estimate.is_conserved) return "conserved";
    if (estimate.is_short)
        return fmt::format(
            "too short: an error takes {} steps and {} collisions; speeds and single "
            "components of the pressure take {} collisions of each disc",
            fewest_short_blocks, fewest_collisions, fewest_collisions);
    if (estimate.is_changing) return "still changing: a trend is not an error";
    if (std::isfinite(estimate.error)) return {};
    if (averages.steps == 0) return "nothing is averaged: no step came after the first one";
    if (std::isnan(estimate.value)) return "it has no meaning in this scene";
    if (std::isinf(estimate.value)) return "no disc met another one";
    return fmt::format("the {} averaged steps make {} block{}, and an error takes {}",
                       averages.steps, averages.n_blocks, averages.n_blocks == 1 ? "" : "s",
                       fewest_blocks);
}

} // namespace carrom

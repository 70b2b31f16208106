// SPDX-License-Identifier: BSD-3-Clause
#include "engine/speed_survey.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

SpeedSpread survey_speeds(std::span<const DiscState> own, double largest_speed,
                          const Communicator& communicator) {
    SpeedSpread::Counts counts{};
    for (const DiscState& disc : own) {
        const double speed = std::sqrt(disc.vx * disc.vx + disc.vy * disc.vy);
        const double part = speed / largest_speed * SpeedSpread::n_parts;
        counts[std::min(static_cast<std::size_t>(part), SpeedSpread::n_parts - 1)] += 1;
    }
    communicator.sum(counts);
    return SpeedSpread(counts, largest_speed);
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
#include "engine/speed_survey.hpp"

#include <algorithm>
#include <cmath>

namespace carrom {

SpeedSpread survey_speeds(std::span<const DiscState> own, double largest_speed,
                          const Communicator& communicator, int n_threads) {
    SpeedSpread::Counts counts{};
#pragma omp parallel num_threads(n_threads)
    {
        SpeedSpread::Counts mine{};
#pragma omp for schedule(static) nowait
        for (std::size_t i = 0; i < own.size(); ++i) {
            const double speed = std::sqrt(own[i].vx * own[i].vx + own[i].vy * own[i].vy);
            const double part = speed / largest_speed * SpeedSpread::n_parts;
            mine[std::min(static_cast<std::size_t>(part), SpeedSpread::n_parts - 1)] += 1;
        }
#pragma omp critical(speeds)
        for (std::size_t part = 0; part < counts.size(); ++part) counts[part] += mine[part];
    }
    communicator.sum(counts);
    return SpeedSpread(counts, largest_speed);
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
#include "engine/engine.hpp"

#include <cmath>

namespace carrom {

void Engine::record_crossing(const DiscState& disc, double x, double y, const Periods& periods) {
    const auto lengths = [](double far, double period) {
        return period == 0 ? 0 : std::round(far / period);
    };
#pragma omp critical(crossings)
    for (std::vector<Crossing>* crossings : crossings_)
        crossings->push_back(
            {disc.id, lengths(x - disc.x, periods.x), lengths(y - disc.y, periods.y)});
}

} // namespace carrom

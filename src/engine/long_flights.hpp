// SPDX-License-Identifier: BSD-3-Clause
// Limits the flights of discs between two syncs in a box with periodic sides, because images are
// counted in 15 bits (core/image.hpp). A scene whose discs fly through more boxes than that is an
// error at its start, and a run ends if its discs become too fast later.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "core/disc_state.hpp"
#include "core/image.hpp"

namespace carrom {

/// The largest number of box lengths that a disc can travel along an axis in `time`, if its speed
/// is at most `speed`, and at most `up` along y. Rows of images may slide along x (shear).
inline double most_lengths(const Periods& periods, double speed, double up, double time) {
    const double rows = periods.y == 0 ? 0 : up * time / periods.y;
    const double along_x = speed + (rows + 1) * std::fabs(periods.speed);
    return std::max(rows, periods.x == 0 ? 0 : along_x * time / periods.x);
}

/// The largest |vy| of these discs.
inline double fastest_up(std::span<const DiscState> discs) {
    double fastest = 0;
    for (const DiscState& disc : discs) fastest = std::max(fastest, std::fabs(disc.vy));
    return fastest;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Discs in flight, and uniform random numbers, for tests of obstacles.
#pragma once

#include <random>

#include "core/disc_state.hpp"

namespace carrom::test {

inline DiscState flying(double x, double y, double vx, double vy, double tau = 0) {
    DiscState disc;
    disc.x = x;
    disc.y = y;
    disc.vx = vx;
    disc.vy = vy;
    disc.tau = tau;
    return disc;
}

inline double uniform(std::mt19937_64& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

} // namespace carrom::test

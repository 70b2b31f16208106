// SPDX-License-Identifier: BSD-3-Clause
// The position and velocity of one disc relative to another. Spaces compute them (space.hpp), and
// the law uses them (law.hpp).
#pragma once

#include "core/device.hpp"

namespace carrom {

/// The vector from one disc's centre to another's.
struct Separation {
    double x = 0, y = 0;
};

/// The vector (ex, ey) from the first disc's centre to the second's, and the velocity (wx, wy) of
/// the second disc relative to the first.
template <class Real> struct Encounter {
    Real ex = 0, ey = 0;
    Real wx = 0, wy = 0;

    CARROM_DEVICE Real square() const { return ex * ex + ey * ey; }
    /// The rate at which the distance between the centres grows, divided by this distance.
    CARROM_DEVICE Real rate() const { return (wx * ex + wy * ey) / (ex * ex + ey * ey); }
};

} // namespace carrom

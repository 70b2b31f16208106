// SPDX-License-Identifier: BSD-3-Clause
// The position and velocity of one disc relative to another. Spaces compute it (space.hpp), and
// laws use it (law.hpp).
#pragma once

#include "core/device.hpp"

namespace carrom {

/// The vector from one disc's centre to another one's.
struct Separation {
    double x = 0, y = 0;
};

/// The separation of the second disc's centre from the first one's, and its relative velocity.
template <class Real> struct Encounter {
    Real ex = 0, ey = 0;
    Real wx = 0, wy = 0;

    CARROM_DEVICE Real square() const { return ex * ex + ey * ey; }
    /// The rate at which the distance of the centres grows, divided by the distance.
    CARROM_DEVICE Real rate() const { return (wx * ex + wy * ey) / (ex * ex + ey * ey); }
};

} // namespace carrom

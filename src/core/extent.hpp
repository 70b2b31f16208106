// SPDX-License-Identifier: BSD-3-Clause
// A rectangle anywhere in the plane.
#pragma once

#include <carrom/box.hpp>

namespace carrom {

struct Extent {
    double x_low = 0, x_high = 0, y_low = 0, y_high = 0;

    Box size() const { return {x_high - x_low, y_high - y_low}; }
};

} // namespace carrom

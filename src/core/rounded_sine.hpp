// SPDX-License-Identifier: BSD-3-Clause
// Sine and cosine that are rounded correctly, so they have the same bits on every processor and
// with every C library. The usual C library is wrong by a little over half a unit in the last
// place, by amounts that depend on the processor, so that one value in 700 differs.
//
// They are computed in pairs of doubles (some 100 bits). Price: about a microsecond.
#pragma once

namespace carrom {

struct RoundedSine {
    double sine = 0, cosine = 1;
};

/// Sine and cosine of an angle from -7 to 7, in radians.
RoundedSine rounded_sine(double angle);

} // namespace carrom

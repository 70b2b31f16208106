// SPDX-License-Identifier: BSD-3-Clause
// Sine and cosine with correct rounding, so they have the same bits on every processor and with
// every C library. The errors of C libraries slightly exceed half a unit in the last place and
// depend on the processor, so that one value in 700 differs.
//
// The computation uses pairs of doubles (some 100 bits). Cost: about a microsecond.
#pragma once

namespace carrom {

struct RoundedSine {
    double sine = 0, cosine = 1;
};

/// Sine and cosine of an angle from -7 to 7, in radians.
RoundedSine rounded_sine(double angle);

} // namespace carrom

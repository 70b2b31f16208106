// SPDX-License-Identifier: BSD-3-Clause
#include "dynamics/sine_series.hpp"

#include <cstdint>

namespace carrom {

SineAndCosine sine_of_turns(double turns) {
    const double quarter = std::floor(4 * turns + 0.5);
    const double x = two_pi * (turns - quarter / 4), square = x * x; // the difference is exact
    const double sine = x + x * (square * series(sine_terms, square));
    const double cosine = (1 - square / 2) + square * (square * series(cosine_terms, square));
    switch (static_cast<std::int64_t>(quarter) & 3) {
    case 0: return {sine, cosine};
    case 1: return {cosine, -sine};
    case 2: return {-sine, -cosine};
    default: return {-cosine, sine};
    }
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The virial of collisions between discs: impulse times distance, summed over collisions. With the
// kinetic part it gives the pressure tensor (docs/understanding/pressure.md).
//
// Sums are exact: neither the order of collisions nor the rank that carries them out affects them.
#pragma once

#include "core/exact_sum.hpp"
#include "dynamics/plain_dynamics.hpp"

namespace carrom {

struct PairVirial {
    /// `bound` exceeds each sum; mass times length squared per micro-step, the same on all ranks.
    explicit PairVirial(double bound) : xx(bound), xy(bound), yy(bound) {}

    /// A disc has got the impulse (ix, iy) from another one at the separation `to` from it. The
    /// mean of xy and yx counts: rough discs make them differ.
    void add(double ix, double iy, const Separation& to) {
        xx.add(-ix * to.x);
        xy.add(-0.5 * (ix * to.y + iy * to.x));
        yy.add(-iy * to.y);
    }
    void clear() { xx.clear(), xy.clear(), yy.clear(); }
    PairVirial& operator+=(const PairVirial& other) {
        xx += other.xx, xy += other.xy, yy += other.yy;
        return *this;
    }
    PairVirial& operator-=(const PairVirial& other) {
        xx -= other.xx, xy -= other.xy, yy -= other.yy;
        return *this;
    }

    ExactSum xx, xy, yy;
};

} // namespace carrom

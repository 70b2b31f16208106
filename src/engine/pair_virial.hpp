// SPDX-License-Identifier: BSD-3-Clause
// The virial of collisions between discs: impulse times distance, summed over collisions. With the
// kinetic part it gives the pressure tensor (docs/understanding/pressure.md).
//
// Sums are exact: neither the order of collisions nor the rank that carries them out affects them.
#pragma once

#include <array>
#include <cstddef>

#include "core/exact_sum.hpp"
#include "dynamics/plain_dynamics.hpp"

namespace carrom {

struct PairVirial {
    /// `bound` exceeds each sum; mass times length squared per micro-step, the same on all ranks.
    explicit PairVirial(double bound) : xx(bound), xy(bound), yy(bound) {}

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

/// Collisions whose terms are still to be added to a virial: many at a time take a third of the
/// instructions.
class VirialTerms {
public:
    /// A disc has got the impulse (ix, iy) from another one at the separation `to` from it. Its
    /// term gets to `sum` at the latest by `add_to`.
    void add(double ix, double iy, const Separation& to, PairVirial& sum) {
        ix_[n_] = ix;
        iy_[n_] = iy;
        x_[n_] = to.x;
        y_[n_] = to.y;
        if (++n_ == most) add_to(sum);
    }
    /// Adds what is left, and forgets it.
    void add_to(PairVirial& sum);

private:
    static constexpr std::size_t most = 64;

    void add_each(PairVirial& sum) const;

    std::array<double, most> ix_{}, iy_{}, x_{}, y_{};
    std::size_t n_ = 0;
};

} // namespace carrom

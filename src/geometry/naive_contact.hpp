// SPDX-License-Identifier: BSD-3-Clause
// The school formula for the time of contact, as the course program has it: kept to be measured
// against the stable one.
//
// It takes B^2 - 4 A C and -B - sqrt(...) as they stand, both differences of like numbers when a
// pair is far apart or grazes: in single precision it misses a fifth of the hits at a thousand
// diameters (docs/accuracy.md), and would miss seven tenths if a discriminant that rounds to 0 were
// no contact. A pair that overlaps, by a rounding even, has its root in the past and passes
// through. `contracted`: products are fused with the sums they go into, as a compiler does with
// -ffp-contract=fast, but written out, so that all compilers do the same.
#pragma once

#include <cmath>

namespace carrom {

template <bool contracted> struct NaiveContact {
    static constexpr bool keeps_digits = false;
    static constexpr bool parts_overlaps = false;

    /// Time until the points come within `sigma`; negative for never, and where they overlap
    /// already.
    template <class Real>
    static Real delay(Real dx, Real dy, Real wx, Real wy, Real sigma, Real /*deepest_overlap*/) {
        const Real none = -1;
        const Real b = 2 * sum_of_products(dx, wx, dy, wy);
        if (!(b < 0)) return none;
        const Real a = sum_of_products(wx, wx, wy, wy);
        const Real square = sum_of_products(dx, dx, dy, dy);
        const Real c = contracted ? std::fma(-sigma, sigma, square) : square - sigma * sigma;
        const Real four_a = 4 * a;
        const Real disc = contracted ? std::fma(b, b, -(four_a * c)) : b * b - four_a * c;
        if (!(disc >= 0)) return none;
        return (-b - std::sqrt(disc)) / (2 * a);
    }

private:
    template <class Real> static Real sum_of_products(Real a, Real b, Real c, Real d) {
        return contracted ? std::fma(a, b, c * d) : a * b + c * d;
    }
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The textbook formula for the time of contact, which the course program uses. The accuracy study
// compares this formula with the stable one (pair_contact.hpp).
//
// The code computes B^2 - 4 A C and -B - sqrt(...) directly. Both subtract nearly equal numbers
// when a pair is far apart or grazes. In single precision the formula misses a fifth of the hits of
// pairs a thousand diameters apart (docs/understanding/accuracy.md). It would miss seven tenths if
// a discriminant that rounds to 0 counted as no contact. If a pair overlaps, even by a rounding
// error, the root is in the past, so the discs pass through each other.
#pragma once

#include <cmath>

#include "core/device.hpp"

namespace carrom {

/// The time until two points come within the distance `sigma`; negative if they never do, or if
/// they are already within it. If `contracted` is true, products and sums are fused as by a
/// compiler with -ffp-contract=fast. The fused operations are written out, so that all compilers
/// give the same result.
template <class Real>
CARROM_DEVICE Real naive_contact_delay(Real dx, Real dy, Real wx, Real wy, Real sigma,
                                       bool contracted) {
    const auto sum_of_products = [contracted](Real a, Real b, Real c, Real d) {
        return contracted ? std::fma(a, b, c * d) : a * b + c * d;
    };
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

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Computes when free discs touch while they grow (docs/understanding/effects.md, section 15).
//
// All radii grow as 1 + g t. In lengths divided by 1 + g t, and with the clock u = t / (1 + g t),
// discs keep their size, and d + w t becomes d + (w - g d) u, so they still fly straight. So the
// predicate of constant sizes (pair_contact.hpp) is used with w - g d in place of w. Each component
// of w - g d is rounded once, by a fused multiply-add. The cross product is taken of d and w for
// any g, so that this rounding does not affect a graze. No bit depends on the order of the pair or
// the names of the axes. Without growth the bits equal the bits of contact_delay.
#pragma once

#include "dynamics/pair_contact.hpp"

namespace carrom {

/// Like contact_delay, for a distance `sigma` that grows at the rate `growth` times `sigma`, with
/// `growth` >= 0. The error is (1 + g t)^2 times the error of contact_delay for w - g d.
template <class Real>
[[gnu::always_inline]] CARROM_DEVICE inline Real growing_contact_delay(Real dx, Real dy, Real wx,
                                                                       Real wy, Real sigma,
                                                                       Real growth,
                                                                       Real deepest_overlap) {
    const Real none = -1;
    const Real vx = std::fma(-growth, dx, wx), vy = std::fma(-growth, dy, wy);
    const Real clock = contact_delay(dx, dy, vx, vy, wx, wy, sigma, deepest_overlap);
    if (clock < 0) return none;
    const Real rest = std::fma(-growth, clock, Real{1});
    return rest > 0 ? clock / rest : none; // the growing discs' clock never reaches 1 / g
}

} // namespace carrom

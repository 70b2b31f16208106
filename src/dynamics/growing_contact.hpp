// SPDX-License-Identifier: BSD-3-Clause
// Computes when freely flying discs that grow touch (docs/understanding/effects.md, section 15).
//
// All radii grow as 1 + g t. In lengths divided by 1 + g t, and with the clock u = t / (1 + g t),
// discs keep their size, and the separation d + w t becomes d + (w - g d) u, so they still fly
// straight. So the predicate for discs of constant size (pair_contact.hpp) is used with w - g d in
// place of w. Each component of w - g d is rounded once, by a fused multiply-add. The cross product
// is computed from d and w, for any g, so that this rounding does not affect a graze. Exchanging
// the two discs or the two axes changes no bit. Without growth the bits equal those of
// contact_delay.
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
    return rest > 0 ? clock / rest : none; // the growing discs' clock u never reaches 1 / g
}

} // namespace carrom

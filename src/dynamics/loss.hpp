// SPDX-License-Identifier: BSD-3-Clause
// The energy that restitution takes in one collision, and the energy that it would have taken if
// the guard (contact_guard.hpp) had not prevented this.
#pragma once

namespace carrom {

/// Energies in units of mass times squared velocity, with velocities as in stored states. The loss
/// by friction at walls is not included.
struct Loss {
    double taken = 0;
    /// The energy that a guarded collision would have taken; 0 for contacts at rest
    double spared = 0;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The energy that restitution takes in one collision, or spares (contact_guard.hpp).
#pragma once

namespace carrom {

/// Mass times squared velocity, in the unit of stored states. Friction of walls is no part of it.
struct Loss {
    double taken = 0;
    double spared = 0; ///< what a guarded collision would have taken; 0 for contacts at rest
};

} // namespace carrom

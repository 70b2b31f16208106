// SPDX-License-Identifier: BSD-3-Clause
// The effects that a scene names, checked: a parameter of an effect that is not there is a problem,
// which names the effect.
#pragma once

#include "scene/check.hpp"

namespace carrom {

/// Fills in `scene.effects`; rule, times and arithmetic must be known by then.
void fill_effects(const Check& check);

/// What can be judged only when box and discs are known.
void check_room_for_effects(const Check& check);

} // namespace carrom

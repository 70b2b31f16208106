// SPDX-License-Identifier: BSD-3-Clause
// Random effects for scenes, each with values at which errors are likely.
#pragma once

#include <cstdint>

#include "scene/scene_parameters.hpp"
#include "scenes.hpp"

namespace carrom::test {

/// The scene with effects that the reader of scenes accepts together with this method and that the
/// references have. Pairs lose nothing, some or all of their energy, or never collide. Walls take
/// energy, are thermal or move. There are periodic sides, gravity and drag. For rough discs,
/// species, obstacles and open sides see troubled_bodies.hpp.
TestScene with_effects(TestScene scene, Method method, std::uint64_t seed);

/// Gives the references functions that they do not compute from a scene's numbers: a thermal wall's
/// draws, drag's clock, contacts of discs that fall.
void hand_to_reference(reference::Setting& setting);

} // namespace carrom::test

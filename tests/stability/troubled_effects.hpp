// SPDX-License-Identifier: BSD-3-Clause
// What troubled scenes meet besides walls and each other: effects drawn at random, each at values
// where it is hard.
#pragma once

#include <cstdint>

#include "scene/scene_parameters.hpp"
#include "scenes.hpp"

namespace carrom::test {

/// The scene with effects that the reader of scenes accepts together under the rule and the
/// references can state: what pairs lose (nothing, some, all) or that they do not meet; walls that
/// take energy, give random velocities (thermal) or move; periodic sides; gravity; drag. For rough
/// discs, species, obstacles and open sides see troubled_bodies.hpp.
TestScene with_effects(TestScene scene, Method method, std::uint64_t seed);

/// What the references are told apart from a scene's numbers: a thermal wall's draws, drag's clock,
/// contacts of discs that fall.
void hand_to_reference(reference::Setting& setting);

} // namespace carrom::test

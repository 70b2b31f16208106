// SPDX-License-Identifier: BSD-3-Clause
// Random scenes drawn for trouble, of discs that differ, that rub and turn, among obstacles, in
// boxes that let discs out.
#pragma once

#include <cstdint>

#include "scene/scene_parameters.hpp"
#include "scenes.hpp"

namespace carrom::test {

/// Up to 12 discs of radii 1 to 1e-3 and masses 1 to 1e6, smooth or rough, with spins. Fixed discs,
/// points, segments and wedges of them. Open sides, and of the other effects what goes together
/// with them (docs/reference/effects.md). Discs touch each other (by their own radii), walls and
/// obstacles, rest in wedges, graze, and meet or leave at the boundaries of micro-steps. None
/// overlaps by more than rounding. The same arguments give the same bits on every machine.
TestScene troubled_bodies(std::uint64_t seed, Method method);

/// Whether no disc is in another one, in an obstacle or outside the box by more than rounding.
bool is_clear(const TestScene& scene);

} // namespace carrom::test

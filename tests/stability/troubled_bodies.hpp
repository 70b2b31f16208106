// SPDX-License-Identifier: BSD-3-Clause
// Random scenes in which errors are likely: discs that differ, rub and turn, among obstacles, in
// boxes from which discs can leave.
#pragma once

#include <cstdint>

#include "scene/scene_parameters.hpp"
#include "scenes.hpp"

namespace carrom::test {

/// Up to 12 discs of radii 1 to 1e-3 and masses 1 to 1e6, smooth or rough, with spins. Fixed discs,
/// points, segments and wedges of segments. Open sides, and other effects that can be combined
/// (docs/reference/effects.md). Discs touch each other, walls and obstacles, rest in wedges, graze,
/// and meet or leave at the boundaries of micro-steps. None overlaps by more than rounding. The
/// same arguments give the same bits on every machine.
TestScene troubled_bodies(std::uint64_t seed, Method method);

/// Whether no disc is in another one, in an obstacle or outside the box by more than rounding.
bool is_clear(const TestScene& scene);

} // namespace carrom::test

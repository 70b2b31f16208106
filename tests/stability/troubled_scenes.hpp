// SPDX-License-Identifier: BSD-3-Clause
// Random scenes in which errors are likely: discs that touch, are aligned, at walls and in corners,
// with equal and opposite speeds, exact binary fractions together with other numbers.
#pragma once

#include <cstdint>

#include "scenes.hpp"

namespace carrom::test {

/// Up to 10 discs that overlap at most by rounding. The same seed gives the same bits on every
/// machine.
TestScene troubled_scene(std::uint64_t seed);

/// Like troubled_scene, with more variety. Up to 40 discs, and patches of a hexagonal lattice with
/// gaps of some ulp. Boxes that are hardly large enough and boxes of up to 1e6 radii. Speeds from
/// 1e-12 to 1e3 diameters a step, and velocities that differ by an ulp. Overlaps, in the
/// time-stepped method only. Numbers of micro-steps that are not a power of two, long sync
/// intervals, all lengths times a power of two.
TestScene wildly_troubled_scene(std::uint64_t seed, bool may_overlap);

} // namespace carrom::test

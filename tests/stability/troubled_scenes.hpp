// SPDX-License-Identifier: BSD-3-Clause
// Random scenes drawn for trouble: touching, aligned, at walls and in corners, equal and opposite speeds, exact binary
// fractions beside numbers that are not. And how a scene that fails is made small.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenes.hpp"

namespace carrom::test {

/// Up to 10 discs that do not overlap by more than rounding. The same seed gives the same bits on every machine.
TestScene troubled_scene(std::uint64_t seed);

/// The same in further ways: up to 40 discs, patches of a hexagonal lattice with gaps of some ulp, boxes that hardly fit and
/// boxes of up to 1e6 radii, speeds from 1e-12 to 1e3 diameters a step, velocities that differ by an ulp, overlaps (under the rule
/// "one" only), micro-steps that are no power of two, long sync intervals, all lengths times a power of two.
TestScene wildly_troubled_scene(std::uint64_t seed, bool may_overlap);

/// The smallest scene found, by leaving out discs, steps and digits, for which `fails` still holds.
TestScene shrunk(TestScene scene, const std::function<bool(const TestScene&)>& fails);

/// The scene as TOML that reads back to the same bits, to be kept in tests/stability/regressions.
std::string toml_of(const TestScene& scene);

/// A scene kept there. With effects it is for its own rule, else for both.
struct Regression {
    TestScene scene;
    std::vector<CollisionRule> rules;
};
Regression read_regression(const std::string& path);

} // namespace carrom::test

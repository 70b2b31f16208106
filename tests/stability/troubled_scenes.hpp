// SPDX-License-Identifier: BSD-3-Clause
// Random scenes drawn for trouble: touching, aligned, at walls and in corners, equal and opposite speeds, exact binary
// fractions beside numbers that are not. And how a scene that fails is made small.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "scenes.hpp"

namespace carrom::test {

/// Up to 10 discs that do not overlap by more than rounding. The same seed gives the same bits on every machine.
TestScene troubled_scene(std::uint64_t seed);

/// The smallest scene found, by leaving out discs, steps and digits, for which `fails` still holds.
TestScene shrunk(TestScene scene, const std::function<bool(const TestScene&)>& fails);

/// The scene as TOML that reads back to the same bits, to be kept in tests/stability/regressions.
std::string toml_of(const TestScene& scene);

/// A scene kept there.
TestScene read_regression(const std::string& path);

} // namespace carrom::test

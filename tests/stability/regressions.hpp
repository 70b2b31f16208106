// SPDX-License-Identifier: BSD-3-Clause
// How a scene that failed is made small, written and kept.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/scene_parameters.hpp"
#include "scenes.hpp"

namespace carrom::test {

/// The smallest scene found, by leaving out discs, effects, steps and digits, for which `fails`
/// still holds.
TestScene shrunk(TestScene scene, const std::function<bool(const TestScene&)>& fails);

/// The scene as TOML that reads back to the same bits, to be kept in tests/stability/regressions;
/// one with effects is for that rule.
std::string toml_of(const TestScene& scene, Method method);

/// A scene kept there. With effects it is for its own rule, else for both.
struct Regression {
    TestScene scene;
    std::vector<Method> methods;
};
Regression read_regression(const std::string& path);

/// The scene of such a text. Throws InputError where the program would refuse it.
Regression regression_of(const std::string& text, const std::string& name);

} // namespace carrom::test

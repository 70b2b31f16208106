// SPDX-License-Identifier: BSD-3-Clause
// Reduces, writes and reads scenes that failed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/scene_parameters.hpp"
#include "scenes.hpp"

namespace carrom::test {

/// The smallest scene found for which `fails` still holds, by removing discs, effects, steps and
/// digits.
TestScene shrunk(TestScene scene, const std::function<bool(const TestScene&)>& fails);

/// The scene as TOML that reads back to the same bits, for tests/stability/regressions; if it has
/// effects, for this method only.
std::string toml_of(const TestScene& scene, Method method);

/// A scene of the folder of regressions. A scene with effects is run by its own method, others by
/// both methods.
struct Regression {
    TestScene scene;
    std::vector<Method> methods;
};
Regression read_regression(const std::string& path);

/// The scene of such a text. Throws InputError if the program would reject it.
Regression regression_of(const std::string& text, const std::string& name);

} // namespace carrom::test

// SPDX-License-Identifier: BSD-3-Clause
// Tests whether two scenes describe the same run. Compares only settings that affect the bits of
// the result.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// One line for each setting that differs, such as "'discs.seed' is 1 there and 2 here". The number
/// of steps, outputs, and lines of discs in files are not compared.
std::vector<std::string> physical_differences(const SceneParameters& there,
                                              const SceneParameters& here);

} // namespace carrom

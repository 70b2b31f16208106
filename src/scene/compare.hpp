// SPDX-License-Identifier: BSD-3-Clause
// Whether two scenes describe the same run. Compares all settings that affect the bits, and no
// others.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// One line for each setting that differs, such as "'discs.seed' is 1 there and 2 here". The length
/// of a run, its outputs, and lines of discs in files are not compared.
std::vector<std::string> physical_differences(const SceneParameters& there,
                                              const SceneParameters& here);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Whether two scenes are the same run: compares all that affects the bits, and nothing else.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// One line for each setting that differs, "'discs.seed' is 1 there and 2 here". The
/// length of a run and its outputs are not compared, nor lines of discs in files.
std::vector<std::string> physical_differences(const SceneParameters& there,
                                              const SceneParameters& here);

} // namespace carrom

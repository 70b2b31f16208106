// SPDX-License-Identifier: BSD-3-Clause
// A checked scene as text again.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace carrom {

/// TOML that reads as the same scene: keys that are not as they are by default. Lines of discs
/// that follow legacy text stay where they are.
std::string scene_text(const Scene& scene);

} // namespace carrom

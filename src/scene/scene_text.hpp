// SPDX-License-Identifier: BSD-3-Clause
// Writes a checked scene as text.
#pragma once

#include <string>

#include "scene/scene_parameters.hpp"

namespace carrom {

/// TOML text that describes the scene: required keys, and keys whose values differ from the
/// default. Lines of discs that follow legacy text are not included.
std::string scene_text(const SceneParameters& scene);

} // namespace carrom

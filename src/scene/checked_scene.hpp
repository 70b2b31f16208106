// SPDX-License-Identifier: BSD-3-Clause
// Settings to a Scene: values, and how they go together. Everything wrong becomes a problem with its line; the scene
// is worth something only if there are none.
#pragma once

#include "carrom/scene/scene.hpp"
#include "settings.hpp"

namespace carrom {

/// Fills in all but the name and the text.
void fill_scene(Scene& scene, const Settings& settings, Problems& problems);

} // namespace carrom

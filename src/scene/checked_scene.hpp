// SPDX-License-Identifier: BSD-3-Clause
// Turns settings into SceneParameters, and checks values and their combinations. Every error
// becomes a problem with its line. The scene is usable only if there are none.
#pragma once

#include "scene/disc_columns.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// Fills in all but the name and the text. Without a valid `discs.count` the number of discs is 0.
/// If box and radius are not valid together, the radius is 0, and so is the box unless a file has
/// the radii. `columns` are the columns of `discs.columns`, if they have been read.
void fill_scene(SceneParameters& scene, Settings& settings, Problems& problems,
                const DiscColumns* columns);

} // namespace carrom

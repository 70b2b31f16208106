// SPDX-License-Identifier: BSD-3-Clause
// Turns settings into SceneParameters, and checks values and their combinations. All errors are
// collected as problems, with lines if known. The scene is usable only if there are none.
#pragma once

#include "scene/disc_columns.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// Fills in `scene`, checks it, and adds errors to `problems`. An unknown number of discs is 0. If
/// box and radii are not valid together, both become 0; but the box is kept if radii are in a file
/// and still unknown. `columns`: the columns of that file; null if it has not been read.
void fill_scene(SceneParameters& scene, Settings& settings, Problems& problems,
                const DiscColumns* columns);

} // namespace carrom

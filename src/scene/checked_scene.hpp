// SPDX-License-Identifier: BSD-3-Clause
// Turns settings into SceneParameters, and checks values and their combinations. All errors are
// collected as problems, with lines if known. The scene is usable only if there are none.
#pragma once

#include "scene/disc_columns.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// Fills in `scene`, checks it, and adds errors to `problems`. A number of discs that is unknown is
/// 0. A box and a radius that are not valid together become 0; the box stays if radii are in a
/// file and still unknown. `columns`: the columns of that file; null if it has not been read.
void fill_scene(SceneParameters& scene, Settings& settings, Problems& problems,
                const DiscColumns* columns);

} // namespace carrom

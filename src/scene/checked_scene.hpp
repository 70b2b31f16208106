// SPDX-License-Identifier: BSD-3-Clause
// Turns settings into SceneParameters, and checks values and their combinations. Every error
// becomes a problem with its line. The scene is usable only if there are no problems.
#pragma once

#include "scene/disc_columns.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// Fills in the members that settings give. An unknown number of discs is stored as 0. If box and
/// radius are not valid together, both become 0; only the box stays if a file has the radii.
/// the radii. `columns` are the columns of `discs.columns`, if they have been read.
void fill_scene(SceneParameters& scene, Settings& settings, Problems& problems,
                const DiscColumns* columns);

} // namespace carrom

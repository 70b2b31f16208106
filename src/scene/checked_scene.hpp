// SPDX-License-Identifier: BSD-3-Clause
// Settings to a Scene: values, and how they go together. Everything wrong becomes a problem with
// its line; the scene is worth something only if there are none.
#pragma once

#include "scene/disc_columns.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// Fills in all but the name and the text. Without a right `discs.count` the number of discs is 0;
/// where box and radius are not right together both are 0. `columns`: those of `discs.columns`,
/// where they have been read.
void fill_scene(Scene& scene, Settings& settings, Problems& problems, const DiscColumns* columns);

} // namespace carrom

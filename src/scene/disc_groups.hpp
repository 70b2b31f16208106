// SPDX-License-Identifier: BSD-3-Clause
// Groups of discs that begin in ways of their own: `discs.groups`.
//
// A group says how many discs of which species begin where, how they are placed and how fast they
// are. Ids count by species first, because a disc's species follows from its id (species.hpp), and
// by group within a species.
#pragma once

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

Key groups_key();

/// Gives groups and species their counts, and the scene both. Refuses rows of which none follow.
/// Comes before all checks of species.
void fill_groups(const SceneDraft& draft);

/// Checks regions, numbers of discs and speeds of groups.
void check_groups(const SceneDraft& draft);

/// The group of a row of `discs.groups`.
DiscGroup group_of(const Numbers& row);

/// The rectangle of a group; the box if it names none.
StartRegion region_of(const SceneParameters& scene, const DiscGroup& group);

} // namespace carrom

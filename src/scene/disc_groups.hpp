// SPDX-License-Identifier: BSD-3-Clause
// Groups of discs with different initial states: `discs.groups`.
//
// A group defines the number, species, region, placement and speed of its discs. Ids are ordered by
// species, because a disc's species follows from its id (species.hpp), and within a species by
// group.
#pragma once

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

Key groups_key();

/// Computes the counts of groups and species, and stores both in the scene. Reports rows without a
/// count. Call it before all checks of species.
void fill_groups(const SceneDraft& draft);

/// Checks regions, numbers of discs and speeds of groups.
void check_groups(const SceneDraft& draft);

/// The group of a row of `discs.groups`.
DiscGroup group_of(const Numbers& row);

/// The rectangle of a group, or the whole box if the group has no region.
StartRegion region_of(const SceneParameters& scene, const DiscGroup& group);

} // namespace carrom

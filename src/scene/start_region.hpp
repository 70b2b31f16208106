// SPDX-License-Identifier: BSD-3-Clause
// Regions for random initial positions: `discs.region` for all discs, or `region` of a species.
#pragma once

#include <optional>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// The rectangle that must contain the whole disc `id` at the start; nothing if the disc may be
/// anywhere in the box.
std::optional<StartRegion> region_of(const SceneParameters& scene, DiscId id);

bool has_regions(const SceneParameters& scene);

/// Why no disc of this radius fits into the region; empty if one fits.
std::string problem_of_region(const SceneParameters& scene, const StartRegion& region,
                              double largest_radius);
/// Why this number of discs, which cover `area`, cannot be placed in the region at random; empty
/// if they can.
std::string problem_of_crowd(const StartRegion& region, std::uint64_t count, double area);

Key region_key();

/// Checks that each region is in the box, and that its discs can be placed in it at random.
void check_regions(const SceneDraft& draft);

} // namespace carrom

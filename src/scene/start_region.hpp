// SPDX-License-Identifier: BSD-3-Clause
// Regions in which discs begin at random: `discs.region` for all, or `region` in a species.
#pragma once

#include <optional>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// The rectangle that disc `id` begins in, whole; nothing if it may begin anywhere in the box.
std::optional<StartRegion> region_of(const SceneParameters& scene, DiscId id);

bool has_regions(const SceneParameters& scene);

/// Why no disc of that radius can begin there, or empty.
std::string problem_of_region(const SceneParameters& scene, const StartRegion& region,
                              double largest_radius);
/// Why so many discs, which cover `area`, find no places at random there, or empty.
std::string problem_of_crowd(const StartRegion& region, std::uint64_t count, double area);

Key region_key();

/// Checks that regions lie in the box, and that discs find places at random in each.
void check_regions(const SceneDraft& draft);

} // namespace carrom

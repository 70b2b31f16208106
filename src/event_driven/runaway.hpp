// SPDX-License-Identifier: BSD-3-Clause
// The highest speed that discs may have in runs in which they may become ever faster. Surfaces that
// have friction and move tangentially (sliding surfaces) do work on discs. If discs do not lose
// this energy, discs between two surfaces collide ever more often, and a step with a disc in a
// wedge may never end.
//
// A run ends if a window's speed bound exceeds 2^17 times the largest of these: the speeds of discs
// at the run's start, the speeds and thermal speeds of walls, and the usual speeds of effects. If
// species have different masses, the limit is multiplied by the square root of their largest ratio,
// which is the ratio of speeds at equal energy. Scenes without sliding surfaces have no limit.
#pragma once

#include "scene/scene_parameters.hpp"

namespace carrom {

/// The speed above which a run ends; infinite for scenes without sliding surfaces. `fastest` is the
/// largest speed of all discs at the start. Both speeds are in lengths per micro-step.
double runaway_speed(const SceneParameters& scene, double fastest);

} // namespace carrom

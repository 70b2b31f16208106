// SPDX-License-Identifier: BSD-3-Clause
// Ends runs whose discs become faster without limit. Surfaces that rub and slide do work on discs.
// If nothing takes up this energy, discs between two surfaces collide ever more often, and a step
// with a disc in a wedge may never end.
//
// A run ends if a disc exceeds 2^17 times the largest usual speed of discs, surfaces, walls and
// effects at the start. The square root of the largest ratio of masses is a further factor, because
// it is the ratio of speeds at equal energy. Scenes without sliding surfaces have no limit.
#pragma once

#include "scene/scene_parameters.hpp"

namespace carrom {

/// The speed per micro-step above which a run ends; infinite for scenes without sliding surfaces.
/// `fastest` is the largest speed of all discs at the start, per micro-step.
double runaway_speed(const SceneParameters& scene, double fastest);

} // namespace carrom

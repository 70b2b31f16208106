// SPDX-License-Identifier: BSD-3-Clause
// The end of runs whose discs become faster without end. Surfaces that rub and slide do work on
// discs. Where nothing takes the energy again, discs between two surfaces collide ever more often:
// a disc in a wedge has no last collision of a step.
//
// A disc ends the run if it is 2^17 times as fast as all that the scene began with: its fastest
// disc, surfaces, walls, fields and bodies that fall. Discs of equal energies may differ in speed
// by the root of the ratio of their masses. Only scenes with surfaces that slide have this limit.
#pragma once

#include "scene/scene_parameters.hpp"

namespace carrom {

/// The speed per micro-step beyond which a run ends; infinite for scenes without surfaces that
/// slide. `fastest` is the speed of the fastest disc of all at the start, per micro-step.
double runaway_speed(const SceneParameters& scene, double fastest);

} // namespace carrom

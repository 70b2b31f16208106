// SPDX-License-Identifier: BSD-3-Clause
// Speeds by which bins and units of sums are chosen when sampling begins, and those of a fall.
#pragma once

#include "measure/measurement.hpp"

namespace carrom {

/// An estimate of speeds that discs get by falling or by being pushed.
double driven_speed(const SceneParameters& scene);

/// The root mean square of a component, or driven_speed if all discs are at rest. **Collective.**
double usual_speed(const MeasuredRun& run);

/// What gravity adds to velocities until half way between two syncs, if contacts last: discs at
/// rest hop from sync to sync, so that is when they have their mean velocity. Otherwise nothing.
struct VelocityChange {
    double x = 0, y = 0;
};
VelocityChange change_until_half_way(const MeasuredRun& run);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Typical speeds, from which bins and units of sums follow when sampling begins, and the velocity
// gained by falling.
#pragma once

#include "measure/measurement.hpp"

namespace carrom {

/// An estimate of the speed that discs gain from accelerations (gravity) and moving walls.
double driven_speed(const SceneParameters& scene);

/// The root mean square of a velocity component of the lightest discs, at the higher temperature of
/// discs and walls; if that is 0, driven_speed; if both are 0, 1. **Collective.**
double usual_speed(const MeasuredRun& run);

/// The velocity that acceleration adds from now until the middle of the present sync interval, in
/// scenes with lasting contacts; otherwise 0. Discs at rest hop from sync to sync, so their
/// velocity in the middle of the interval is their mean velocity.
struct VelocityChange {
    double x = 0, y = 0;
};
VelocityChange change_until_half_way(const MeasuredRun& run);

} // namespace carrom

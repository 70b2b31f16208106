// SPDX-License-Identifier: BSD-3-Clause
// Typical speeds, which determine bins and units of sums when sampling begins, and the velocity
// that discs gain from acceleration.
#pragma once

#include "measure/measurement.hpp"

namespace carrom {

/// An estimate of the speed that discs gain from accelerations (gravity) and moving walls.
double driven_speed(const SceneParameters& scene);

/// The root mean square of a velocity component of the lightest discs, at the temperature of the
/// discs or of the hottest wall, whichever is higher. If it is 0, this returns driven_speed, or 1
/// if that is 0, too. **Collective.**
double usual_speed(const MeasuredRun& run);

/// In scenes with lasting contacts, the velocity that acceleration adds from now until the middle
/// of the present sync interval (negative after the middle); otherwise 0. Discs at rest hop from
/// sync to sync, so their velocity in the middle of the interval is their mean velocity.
struct VelocityChange {
    double x = 0, y = 0;
};
VelocityChange change_until_half_way(const MeasuredRun& run);

} // namespace carrom

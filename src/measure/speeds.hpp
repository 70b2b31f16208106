// SPDX-License-Identifier: BSD-3-Clause
// Speeds by which bins and units of sums are chosen when sampling begins.
#pragma once

#include "measure/measurement.hpp"

namespace carrom {

/// An estimate of speeds that discs get by falling or by being pushed.
double driven_speed(const SceneParameters& scene);

/// The root mean square of a component, or driven_speed if all discs are at rest. **Collective.**
double usual_speed(const MeasuredRun& run);

} // namespace carrom

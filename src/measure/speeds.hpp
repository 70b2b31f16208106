// SPDX-License-Identifier: BSD-3-Clause
// Speeds that bins and units of sums are chosen by when sampling begins.
#pragma once

#include "measure/measurement.hpp"

namespace carrom {

/// How fast discs may become by falling or by being pushed.
double driven_speed(const Scene& scene);

/// The root mean square of a component; that of driven discs where all are at rest. **Collective.**
double usual_speed(const MeasuredRun& run);

} // namespace carrom

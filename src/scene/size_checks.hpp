// SPDX-License-Identifier: BSD-3-Clause
// The checks of radii that follow a distribution.
#pragma once

#include "scene/scene_draft.hpp"

namespace carrom {

/// If radii follow a distribution, reports each other key that also defines radii. The number of
/// discs may still be unknown.
void check_rivals_of_sizes(const SceneDraft& draft);

/// Whether radii can be computed: keys are valid, the mean or the packing is given, and the limits
/// contain radii. Reports other cases.
bool check_distribution(const SceneDraft& draft);

} // namespace carrom

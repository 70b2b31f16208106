// SPDX-License-Identifier: BSD-3-Clause
// The checks of radii that follow a distribution.
#pragma once

#include "scene/scene_draft.hpp"

namespace carrom {

/// If radii follow a distribution, reports other keys that define radii, too. The number of discs
/// may be unknown.
void check_rivals_of_sizes(const SceneDraft& draft);

/// Whether radii can be computed: keys are valid, one gives the mean, and limits leave some radii.
bool check_distribution(const SceneDraft& draft);

} // namespace carrom

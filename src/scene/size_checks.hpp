// SPDX-License-Identifier: BSD-3-Clause
// The checks of radii that follow a distribution.
#pragma once

#include "scene/scene_draft.hpp"

namespace carrom {

/// A distribution gives the radii alone, also where the number of discs is not known yet.
void check_rivals_of_sizes(const SceneDraft& draft);

/// Whether radii can follow the distribution: its limits are in order and not too small.
bool check_distribution(const SceneDraft& draft);

} // namespace carrom

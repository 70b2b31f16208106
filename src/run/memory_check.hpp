// SPDX-License-Identifier: BSD-3-Clause
// Whether a run's discs fit into memory. A run of too many would end later without a reason.
#pragma once

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// InputError on every rank if the discs need more memory than a rank has. `bytes_for_crowds` is
/// what a disc takes beyond one of an even gas, where that is known. **Collective.**
void check_memory(const SceneParameters& scene, const Communicator& ranks,
                  double bytes_for_crowds = 0);

} // namespace carrom

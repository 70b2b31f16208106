// SPDX-License-Identifier: BSD-3-Clause
// Checks that a run's discs fit into memory; if not, the system would end it without a message.
#pragma once

#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Throws InputError on every rank if the discs need more memory than a rank has.
/// `bytes_for_crowds`: extra bytes per disc if discs are clustered. **Collective.**
void check_memory(const SceneParameters& scene, const Communicator& ranks,
                  double bytes_for_crowds = 0);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Writes the few discs around a failed self-check as a scene that can be run again.
#pragma once

#include <string>

#include "check/check_failure.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Writes check_step_S_disc_D.toml and .discs to `folder` ("" for the working folder):
/// one step, from the begin of the failed step. Returns a sentence on what was
/// written, or why nothing was. Called on one rank.
std::string write_failure_scene(const std::string& folder, const SceneParameters& scene,
                                const CheckFailure& failure);

/// Lets rank 0 write the discs around the failure to the working folder. Returns the
/// error to throw on every rank, code 70. **Collective.**
CollectiveError reported(const CheckFailure& failure, const SceneParameters& scene,
                         const Communicator& ranks);

} // namespace carrom

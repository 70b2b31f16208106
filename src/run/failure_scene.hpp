// SPDX-License-Identifier: BSD-3-Clause
// Writes the few discs around the disc that failed a self-check as a scene that can be run again.
#pragma once

#include <string>

#include "check/check_failure.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Writes check_step_S_disc_D.toml and .discs to `folder` ("" for the working folder): a scene of
/// one step from the beginning of the failed step. Returns a sentence about the written files, or
/// why there are none. Called on one rank.
std::string write_failure_scene(const std::string& folder, const SceneParameters& scene,
                                const CheckFailure& failure);

/// Lets rank 0 write the discs around the failure to the working folder. Returns the error (code
/// 70) that every rank must throw. **Collective.**
CollectiveError reported(const CheckFailure& failure, const SceneParameters& scene,
                         const Communicator& ranks);

} // namespace carrom

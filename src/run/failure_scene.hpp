// SPDX-License-Identifier: BSD-3-Clause
// Where a self-check has failed: the few discs around, as a scene that can be run again.
#pragma once

#include <string>

#include "check/check_failure.hpp"
#include "parallel/communicator.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// Writes check_step_S_disc_D.toml and .discs to `folder` ("" for where the program runs): one
/// step, from the failed step's begin. Returns a sentence that says what was written, or why
/// nothing was. One rank calls this.
std::string write_failure_scene(const std::string& folder, const Scene& scene,
                                const CheckFailure& failure);

/// Lets rank 0 write the neighbourhood to where the program runs; what to throw on every rank:
/// code 70. **Collective.**
CollectiveError reported(const CheckFailure& failure, const Scene& scene,
                         const Communicator& ranks);

} // namespace carrom

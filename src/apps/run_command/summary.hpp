// SPDX-License-Identifier: BSD-3-Clause
// The human-readable summary of a finished run.
#pragma once

#include <string>

#include "apps/run_command/run_result.hpp"

namespace carrom {

/// The summary as lines of text; each ends with a line break.
std::string summary_text(const SceneParameters& scene, const RunResult& result);

} // namespace carrom

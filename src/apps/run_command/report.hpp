// SPDX-License-Identifier: BSD-3-Clause
// The report of a finished run for other programs.
#pragma once

#include <string>

#include "apps/run_command/run_result.hpp"

namespace carrom {

/// A JSON object; keys are described in docs/reference/report.md.
std::string report_text(const SceneParameters& scene, const RunResult& result);

} // namespace carrom

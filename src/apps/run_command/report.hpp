// SPDX-License-Identifier: BSD-3-Clause
// The report of a finished run, in a form for other programs.
#pragma once

#include <string>

#include "apps/run_command/run_result.hpp"

namespace carrom {

/// The report as a JSON object; docs/reference/report.md describes its keys.
std::string report_text(const SceneParameters& scene, const RunResult& result);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// What a run says of itself to people when it is over.
#pragma once

#include <string>

#include "apps/run/run_result.hpp"

namespace carrom {

/// Lines of text, each ended.
std::string summary_text(const Scene& scene, const RunResult& result);

} // namespace carrom

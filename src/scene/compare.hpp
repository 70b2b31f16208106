// SPDX-License-Identifier: BSD-3-Clause
// Whether two scenes are the same run: everything that affects the bits, and nothing else.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace carrom {

/// One line for each setting that differs, "'discs.seed' is 1 there and 2 here". How long a run
/// goes on and what it writes are no differences. Lines of discs in files are not looked at.
std::vector<std::string> physical_differences(const Scene& there, const Scene& here);

} // namespace carrom

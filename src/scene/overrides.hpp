// SPDX-License-Identifier: BSD-3-Clause
// Overrides: settings `key=value` from the command line, Python or a checkpoint. They replace the
// same keys of the input, and remove keys that they exclude: `discs.packing` removes a radius, and
// another generator removes the keys that have no meaning for it.
#pragma once

#include <string>
#include <vector>

#include "scene/settings.hpp"

namespace carrom {

void add_overrides(Settings& settings, Problems& problems,
                   const std::vector<std::string>& overrides);

/// The error message for an override that has no key or no `=`.
std::string form_problem(const std::string& text);

} // namespace carrom

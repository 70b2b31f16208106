// SPDX-License-Identifier: BSD-3-Clause
// Settings from the command line, `key=value`. They replace those of the input, and
// all that they exclude there: `discs.packing` replaces a radius, another generator
// replaces the keys that have no meaning for it.
#pragma once

#include <string>
#include <vector>

#include "scene/settings.hpp"

namespace carrom {

void add_overrides(Settings& settings, Problems& problems,
                   const std::vector<std::string>& overrides);

/// The problem of a text without a key or without `=`.
std::string form_problem(const std::string& text);

} // namespace carrom

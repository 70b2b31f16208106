// SPDX-License-Identifier: BSD-3-Clause
// TOML text to settings, with the line of each. Types are checked here, values are not.
#pragma once

#include <string>
#include <string_view>

#include "scene/settings.hpp"

namespace carrom {

/// False where the text is not TOML at all, so that nothing can be said about its keys.
bool add_toml(Settings& settings, Problems& problems, std::string_view text,
              const std::string& name);

/// One value in TOML's syntax for a known `key`, as `--set` gives it; words need no quotes.
void add_toml_value(Settings& settings, Problems& problems, const std::string& key,
                    const std::string& value, const Place& place);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// TOML text to settings and back. What values may be is checked later, against their keys.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/key.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// False where the text is not TOML at all, so that nothing can be said about its keys.
bool add_toml(Settings& settings, Problems& problems, std::string_view text,
              const std::string& name);

/// One value as `--set` gives it: in TOML's syntax, but words need no quotes where the key takes
/// one. Nothing where it is no value.
std::optional<Value> parse_value(const Key& key, const std::string& text);

/// A checked value in TOML's syntax; it reads back as the same bits.
std::string toml_text(const Key& key, const Value& value);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Converts TOML text to settings and back. Values are checked later, against their keys.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/key.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// Adds the settings of a text. If it is not valid TOML, adds none, and returns false.
bool add_toml(Settings& settings, Problems& problems, std::string_view text,
              const std::string& name);

/// Reads a value of `--set`. It has TOML's syntax, but words need no quotes if the key takes a
/// word. Returns nothing if it is not a value.
std::optional<Value> parse_value(const Key& key, const std::string& text);

/// Reads an inline table of `--set`. Returns nothing if the text is not a table.
std::optional<NamedValues> parse_table(const std::string& text);

/// The checked value in TOML's syntax. If it is read again, numbers have the same bits.
std::string toml_text(const Key& key, const Value& value);

} // namespace carrom

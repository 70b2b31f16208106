// SPDX-License-Identifier: BSD-3-Clause
// TOML text to settings and back. Values are checked later, by their keys.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/key.hpp"
#include "scene/settings.hpp"

namespace carrom {

/// Returns false if the text is no TOML at all, so that nothing is known about its keys.
bool add_toml(Settings& settings, Problems& problems, std::string_view text,
              const std::string& name);

/// Reads a value of `--set`. It is in TOML's syntax, but words need no quotes if the
/// key takes a word. Nothing if it is no value.
std::optional<Value> parse_value(const Key& key, const std::string& text);

/// Reads an inline table of `--set`. Nothing if it is none.
std::optional<NamedValues> parse_table(const std::string& text);

/// A checked value in TOML's syntax; it reads back as the same bits.
std::string toml_text(const Key& key, const Value& value);

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Messages about unknown keys, with the name that a misspelt key was most likely meant to be.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scene/settings.hpp"

namespace carrom {

/// The new name of a renamed key (and of its `value`), or the nearest name by edit
/// distance, or the existing names.
std::string unknown_key_text(std::string_view key, const Value& value);

/// What there is instead of a key that people try, as they know it from other programs; else empty.
std::string instead_of(std::string_view key);

/// The text about a table that the input gives as one value.
std::string table_text(std::string_view key, const Value& value);

/// "; did you mean \"all\"?" with the nearest of a few names, in `quote`s; empty if
/// none is near enough: one letter wrong, or up to a third of the letters.
std::string guess(std::string_view name, std::span<const std::string_view> names, char quote);

/// Insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

} // namespace carrom

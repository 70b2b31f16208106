// SPDX-License-Identifier: BSD-3-Clause
// Messages about unknown keys, with the name that was probably meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scene/settings.hpp"

namespace carrom {

/// The new name of a renamed key (and of its `value`), or the nearest name by edit
/// distance, or the existing names.
std::string unknown_key_text(std::string_view key, const Value& value);

/// The advice for a key that people try because other programs have it; else empty.
std::string instead_of(std::string_view key);

/// The message for a table that the input gives as one value.
std::string table_text(std::string_view key, const Value& value);

/// Text such as "; did you mean \"all\"?" with the nearest of a few names, in `quote`s. It is empty
/// if no name is near enough, which means one wrong letter, or up to a third of the letters.
std::string guess(std::string_view name, std::span<const std::string_view> names, char quote);

/// The number of insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

} // namespace carrom

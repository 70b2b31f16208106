// SPDX-License-Identifier: BSD-3-Clause
// Messages about unknown keys, with the name that was probably meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scene/settings.hpp"

namespace carrom {

/// The message for an unknown key. It contains the new name of a renamed key (and of its `value`),
/// or advice, or the most similar name by edit distance, or all existing names.
std::string unknown_key_text(std::string_view key, const Value& value);

/// The advice for a key that users may expect but Carrom lacks; empty for other keys.
std::string instead_of(std::string_view key);

/// The message for a table to which the input gives a single value.
std::string table_text(std::string_view key, const Value& value);

/// Text such as "; did you mean 'all'?" with the name nearest to `name`, between `quote`s; empty if
/// every name differs in more than one letter and in more than a third of the letters.
std::string guess(std::string_view name, std::span<const std::string_view> names, char quote);

/// Least number of letters to insert, delete, replace or swap with the next one to turn a into b.
std::size_t edit_distance(std::string_view a, std::string_view b);

} // namespace carrom

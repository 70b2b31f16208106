// SPDX-License-Identifier: BSD-3-Clause
// What to say of a key that there is not, and the name a misspelt one was most likely meant to be.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scene/settings.hpp"

namespace carrom {

/// The new name of a renamed key (and of its `value`), or the nearest name by edit distance, or
/// the names that there are.
std::string unknown_key_text(std::string_view key, const Value& value);

/// "; did you mean \"all\"?" with the nearest of a few names, each end of it in `quote`; empty
/// where none is near: one letter wrong, or up to a third of them.
std::string guess(std::string_view name, std::span<const std::string_view> names, char quote);

/// Insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

} // namespace carrom

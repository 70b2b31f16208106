// SPDX-License-Identifier: BSD-3-Clause
// Checks values of settings against their keys: kind, range, words, shape of rows.
#pragma once

#include <string>

#include "scene/key.hpp"

namespace carrom {

/// Converts the value to the form that the key's `set` accepts. For an invalid value, adds problems
/// and marks the setting as wrong. An invalid row of an array becomes `monostate`.
void check_value(const Key& key, Setting& setting, Problems& problems);

/// Text such as "a number greater than 0" or "an array of [x, y, radius]".
std::string kind_text(const Key& key);
/// Text such as "from 0 to 1" or "greater than 0"; empty if every number is allowed.
std::string range_text(const Range& range);
/// Human-readable text of a number: very large and very small powers of two are printed like 2^53.
std::string number_text(double number);
/// The shortest decimal that reads back as the same bits.
std::string decimal_text(double number);
/// The words in quotes, joined by commas and "or".
std::string words_text(const std::vector<std::string_view>& words);

} // namespace carrom

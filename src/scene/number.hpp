// SPDX-License-Identifier: BSD-3-Clause
// Reads numbers from text by std::from_chars, which rounds correctly and does not depend on the
// locale. The number must fill the whole text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace carrom {

std::optional<double> parse_double(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);
std::optional<std::uint64_t> parse_id(std::string_view text);

/// The mark that some editors write at the start of UTF-8 text.
inline constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

/// The text without blanks (space, tab, carriage return) at both ends.
std::string_view trimmed(std::string_view text);

/// Splits `line` at blanks into at most `limit` words; if it has more words, the last entry
/// contains the rest of the line.
void split_words(std::string_view line, std::size_t limit, std::vector<std::string_view>& words);

/// `text` in quotes, cut to a readable length, with control characters shown as `?`.
std::string in_quotes(std::string_view text);

} // namespace carrom

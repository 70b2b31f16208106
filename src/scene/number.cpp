// SPDX-License-Identifier: BSD-3-Clause
#include "scene/number.hpp"

#include <charconv>

namespace carrom {

namespace {

constexpr std::string_view blanks = " \t\r";

template <class Number> std::optional<Number> parse(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+')
        text.remove_prefix(1);
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return number;
}

} // namespace

std::optional<double> parse_double(std::string_view text) { return parse<double>(text); }
std::optional<std::int64_t> parse_integer(std::string_view text) {
    return parse<std::int64_t>(text);
}
std::optional<std::uint64_t> parse_id(std::string_view text) { return parse<std::uint64_t>(text); }

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

void split_words(std::string_view line, std::size_t limit, std::vector<std::string_view>& words) {
    words.clear();
    line = trimmed(line);
    while (!line.empty()) {
        const std::size_t end = words.size() < limit ? line.find_first_of(blanks)
                                                     : std::string_view::npos;
        words.push_back(line.substr(0, end));
        line = end == std::string_view::npos ? std::string_view{} : trimmed(line.substr(end));
    }
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string result = "'";
    for (const char c : text.substr(0, longest))
        result += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
    return result + (text.size() > longest ? "...'" : "'");
}

} // namespace carrom

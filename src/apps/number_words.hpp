// SPDX-License-Identifier: BSD-3-Clause
// Words of the command line that are to be numbers.
#pragma once

#include <charconv>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "core/errors.hpp"

namespace carrom {

inline constexpr double least_above_0 = std::numeric_limits<double>::min();

/// A finite number from `least` to `most`. Nothing for an empty word, which leaves the default, and
/// for a wrong one, of which a problem is noted; `why` says where the limits come from.
template <class Number>
std::optional<Number> number_of(const char* option, const std::string& word, Number least,
                                Number most, std::vector<Problem>& problems,
                                const std::string& why = "") {
    if (word.empty()) return std::nullopt;
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_number = error == std::errc{} && end == word.data() + word.size();
    if (is_number && value >= least && value <= most) return value; // no NaN is
    using Limits = std::numeric_limits<Number>;
    const char* const kind = Limits::is_integer ? "a whole number" : "a number";
    std::string range = fmt::format("from {} to {}", least, most);
    if (most == Limits::max()) range = fmt::format("from {} on", least);
    if constexpr (!Limits::is_integer)
        if (least == least_above_0) range = "above 0";
    problems.push_back(
        {option, 0, fmt::format("must be {} {}{}, not \"{}\"", kind, range, why, word)});
    return std::nullopt;
}

} // namespace carrom

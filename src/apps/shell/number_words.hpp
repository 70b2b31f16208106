// SPDX-License-Identifier: BSD-3-Clause
// Reads numbers from words of the command line.
#pragma once

#include <charconv>
#include <limits>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "apps/shell/subcommand.hpp"

namespace carrom {

inline constexpr double least_above_0 = std::numeric_limits<double>::min(),
                        largest_double = std::numeric_limits<double>::max();

/// Makes a function that stores a finite number from `least` to `most` in `number`. `why` is the
/// reason for the limits. `number` must live as long as the returned function.
template <class Target, class Number>
TakeWord number(Target& number, Number least, Number most, const char* why = "") {
    return [=, &number](const char* option, const std::string& word,
                        std::vector<Problem>& problems) {
        Number value{};
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        const bool is_number = error == std::errc{} && end == word.data() + word.size();
        if (is_number && value >= least && value <= most) { // false for NaN
            number = value;
            return;
        }
        using Limits = std::numeric_limits<Number>;
        const char* const kind = Limits::is_integer ? "a whole number" : "a number";
        std::string range = fmt::format("from {} to {}", least, most);
        if (most == Limits::max()) range = fmt::format("from {} on", least);
        if constexpr (!Limits::is_integer)
            if (least == least_above_0) range = "above 0";
        problems.push_back(
            {option, 0, fmt::format("must be {} {}{}, not \"{}\"", kind, range, why, word)});
    };
}

} // namespace carrom

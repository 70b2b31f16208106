// SPDX-License-Identifier: BSD-3-Clause
#include "grading/lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/errors.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

constexpr std::size_t words_of_a_disc = 6, words_with_counters = 8;

/// 0.01 for 1.25, 0.0001 for 1.25e-2; 0 for a whole number, which does not show its rounding.
double last_digit_of(std::string_view word) {
    const std::size_t point = word.find('.');
    if (point == std::string_view::npos) return 0;
    const std::size_t mantissa_end = std::min(word.find_first_of("eE"), word.size());
    int exponent = 0;
    if (mantissa_end < word.size()) {
        std::string_view digits = word.substr(mantissa_end + 1);
        if (digits.starts_with('+')) digits.remove_prefix(1);
        std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    }
    return std::pow(10.0, exponent - static_cast<double>(mantissa_end - point - 1));
}

} // namespace

StudentOutput::StudentOutput(std::istream& stream, std::string name)
    : lines_(stream, 0), name_(std::move(name)) {}

void StudentOutput::refuse(const std::string& text) const {
    throw InputError({{name_, lines_.line_number(), text}});
}

double StudentOutput::number(std::string_view word) const {
    const std::optional<double> value = parse_double(word);
    if (!value) refuse(in_quotes(word) + " is no number; a line is `step id x y vx vy`");
    return *value;
}

std::uint64_t StudentOutput::count(std::string_view word) const {
    const std::optional<std::uint64_t> value = parse_id(word);
    if (!value) refuse(in_quotes(word) + " is no whole number from 0 on");
    return *value;
}

bool StudentOutput::next(StudentLine& line) {
    std::string_view text;
    do {
        if (!lines_.next(text)) {
            if (lines_.has_failed() || lines_.is_endless()) refuse("cannot be read to its end");
            return false;
        }
        if (lines_.is_cut()) refuse("a line of more than 4096 characters");
        split_words(text, words_with_counters, words_);
    } while (words_.empty());
    if (words_.size() != words_of_a_disc && words_.size() != words_with_counters)
        refuse("is no line of a disc: `step id x y vx vy`, in the last step also `p_c w_c`");
    line = {};
    line.finest_digit = std::numeric_limits<double>::infinity();
    line.number = lines_.line_number();
    line.step = static_cast<std::int64_t>(count(words_[0]) & ~(std::uint64_t{1} << 63));
    line.id = count(words_[1]);
    double* const numbers[] = {&line.x, &line.y, &line.vx, &line.vy};
    for (std::size_t i = 0; i < 4; ++i) {
        *numbers[i] = number(words_[2 + i]);
        const double digit = last_digit_of(words_[2 + i]);
        line.last_digit = std::max(line.last_digit, digit);
        if (digit > 0) line.finest_digit = std::min(line.finest_digit, digit);
    }
    line.has_counters = words_.size() == words_with_counters;
    if (line.has_counters) {
        line.pair_collisions = count(words_[6]);
        line.wall_collisions = count(words_[7]);
    }
    return true;
}

} // namespace carrom

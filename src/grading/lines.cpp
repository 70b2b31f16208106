// SPDX-License-Identifier: BSD-3-Clause
#include "grading/lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

constexpr std::size_t words_of_a_disc = 6, words_with_counters = 8;

/// The unit of the last digit: 0.01 for 1.25, 0.0001 for 1.25e-2. It is 0 for a whole number, which
/// does not show its rounding.
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

/// Whether the line begins with a step and an id, and has as many words as the line of a disc.
bool StudentOutput::is_disc() const {
    return (words_.size() == words_of_a_disc || words_.size() == words_with_counters) &&
           parse_id(words_[0]) && parse_id(words_[1]);
}

void StudentOutput::leave_out(std::string_view text) {
    if (++n_left_out_ > 1) return;
    first_left_out_ = lines_.line_number();
    left_out_ = trimmed(text);
}

/// Reads the output up to the next line of a disc, and splits this line into words.
bool StudentOutput::next_words() {
    std::string_view text;
    for (;;) {
        if (!lines_.next(text)) {
            if (lines_.has_failed() || lines_.is_endless()) refuse("cannot be read to its end");
            if (n_left_out_ > 0 && !has_discs_)
                throw InputError({{name_, first_left_out_,
                                   "is no line of a disc, and no other line is one: `step id x y "
                                   "vx vy`, in the last step also `p_c w_c`"}});
            return false;
        }
        if (lines_.is_cut()) refuse("a line of more than 4096 characters");
        split_words(text, words_with_counters, words_);
        if (is_disc()) break;
        if (!words_.empty()) leave_out(text);
    }
    has_discs_ = true;
    return true;
}

bool StudentOutput::next(StudentLine& line) {
    if (!next_words()) return false;
    line = {};
    line.finest_digit = std::numeric_limits<double>::infinity();
    line.number = lines_.line_number();
    line.step = static_cast<std::int64_t>(count(words_[0]) & ~(std::uint64_t{1} << 63));
    line.id = count(words_[1]);
    double* const numbers[] = {&line.x, &line.y, &line.vx, &line.vy};
    for (std::size_t i = 0; i < 4; ++i) {
        *numbers[i] = number(words_[2 + i]);
        const double digit = line.digits[i] = last_digit_of(words_[2 + i]);
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

std::string StudentOutput::remark() const {
    if (n_left_out_ == 0) return {};
    const std::string first = fmt::format("line {}: {}", first_left_out_, in_quotes(left_out_));
    if (n_left_out_ == 1)
        return fmt::format("remark: a line was left out, because it is no line of a disc: {}\n",
                           first);
    return fmt::format("remark: {} lines were left out, because they are no lines of discs; the "
                       "first is {}\n",
                       n_left_out_, first);
}

} // namespace carrom

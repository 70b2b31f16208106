// SPDX-License-Identifier: BSD-3-Clause
#include "scene/checked_value.hpp"

#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scene/number.hpp"
#include "scene/unknown_key.hpp"

namespace carrom {

namespace {

/// The word in lower case, without `-`, `_` and blanks, so that Nose-Hoover equals nosehoover.
std::string letters_of(std::string_view word) {
    std::string letters;
    for (const char c : word)
        if (c != '-' && c != '_' && c != ' ')
            letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return letters;
}

constexpr std::size_t most_wrong_rows = 20; ///< wrong rows beyond this number are only counted

std::string value_text(const Value& value) {
    if (std::holds_alternative<bool>(value.data)) return "true or false";
    if (std::holds_alternative<std::int64_t>(value.data)) return "a whole number";
    if (std::holds_alternative<double>(value.data)) return "a number";
    if (const auto* text = std::get_if<std::string>(&value.data)) return in_quotes(*text);
    if (std::holds_alternative<Values>(value.data)) return "an array";
    if (std::holds_alternative<NamedValues>(value.data)) return "a table";
    return "a date or time";
}

std::optional<double> as_number(const Value& value) {
    if (const auto* integer = std::get_if<std::int64_t>(&value.data))
        return static_cast<double>(*integer);
    if (const auto* number = std::get_if<double>(&value.data)) return *number;
    return std::nullopt;
}

/// Checks one setting against its key.
class ValueCheck {
public:
    ValueCheck(const Key& key, Setting& setting, Problems& problems)
        : key_(key), setting_(setting), problems_(problems) {}

    void check() {
        switch (key_.kind) {
        case Kind::number: return check_number();
        case Kind::lengths: return check_lengths();
        case Kind::point: return check_point();
        case Kind::integer: return check_integer();
        case Kind::flag: return check_type<bool>();
        case Kind::text: return check_text();
        case Kind::choice: return check_word(setting_.value);
        case Kind::words: return check_words();
        case Kind::rows:
        case Kind::tables: return check_rows();
        }
    }

private:
    void refuse(std::string text) { refuse_at(setting_.value.line, std::move(text)); }
    void refuse_at(std::int64_t line, std::string text) {
        setting_.is_wrong = true;
        add_problem(problems_, {setting_.place.name, line}, std::move(text));
    }
    void refuse_type() {
        refuse(fmt::format("'{}' must be {}, not {}", key_.name, kind_text(key_),
                           value_text(setting_.value)));
    }
    void refuse_number(double number) {
        refuse(fmt::format("'{}' must be {}, not {}", key_.name, kind_text(key_), number));
    }
    template <class Type> void check_type() {
        if (!std::holds_alternative<Type>(setting_.value.data)) refuse_type();
    }

    void check_range(double number) {
        const Range& range = key_.range;
        if (range.allows_zero && number == 0) return;
        const bool is_high_enough = range.excludes_low ? number > range.low : number >= range.low;
        if (is_high_enough && number <= range.high) return;
        refuse(fmt::format("'{}' must be {}, not {}{}{}", key_.name, range_text(range), number,
                           range.why.empty() ? "" : ": ", range.why));
    }
    void check_number() {
        const auto number = as_number(setting_.value);
        if (!number) return refuse_type();
        setting_.value.data = *number;
        if (!std::isfinite(*number)) return refuse_number(*number);
        check_range(*number);
    }
    void check_point() {
        if (std::holds_alternative<std::string>(setting_.value.data))
            return check_word(setting_.value);
        const auto* list = std::get_if<Values>(&setting_.value.data);
        if (!list) return refuse_type();
        check_pair(*list);
    }
    /// Checks an edge length, or an array of two edge lengths.
    void check_lengths() {
        const auto* list = std::get_if<Values>(&setting_.value.data);
        if (!list) return check_number();
        check_pair(*list);
    }
    void check_pair(const Values& list) {
        const auto refuse_list = [&](const std::string& found) {
            refuse(fmt::format("'{}' must be {}, not {}", key_.name, kind_text(key_), found));
        };
        if (list.size() != 2) return refuse_list(fmt::format("an array of {}", list.size()));
        Numbers numbers;
        for (const Value& one : list) {
            const auto number = as_number(one);
            if (!number || !std::isfinite(*number))
                return refuse_list(fmt::format("[..., {}, ...]", value_text(one)));
            check_range(*number);
            numbers.push_back(*number);
        }
        if (setting_.is_wrong) return;
        setting_.value.data = std::move(numbers);
    }
    /// Checks a whole number, which may be written like 1e5.
    void check_integer() {
        const auto number = as_number(setting_.value);
        if (!number) return refuse_type();
        if (!std::isfinite(*number) || *number != std::floor(*number))
            return refuse_number(*number);
        check_range(*number);
        if (setting_.is_wrong || std::holds_alternative<std::int64_t>(setting_.value.data)) return;
        if (*number >= 0x1p63)
            return refuse(fmt::format("'{}' must be below 2^63, not {}", key_.name, *number));
        setting_.value.data = static_cast<std::int64_t>(*number);
    }
    void check_text() {
        check_type<std::string>();
        if (setting_.is_wrong) return;
        const std::string& text = std::get<std::string>(setting_.value.data);
        if (text.empty()) refuse(fmt::format("'{}' is empty", key_.name));
        if (text.find('\0') != std::string::npos)
            refuse(fmt::format("'{}' has a NUL character; no file has one in its name", key_.name));
    }
    void check_word(const Value& value) {
        const auto* word = std::get_if<std::string>(&value.data);
        if (!word) return refuse_type();
        const std::string kinds = key_.kind == Kind::point ? kind_text(key_)
                                                           : words_text(key_.words);
        for (const std::string_view known : key_.words)
            if (known == *word) return;
        for (const auto& [old_word, new_word] : key_.old_words)
            if (old_word == *word)
                return refuse(
                    fmt::format("'{}': \"{}\" is now \"{}\"", key_.name, old_word, new_word));
        for (const auto& [other, here] : key_.advice)
            if (letters_of(other) == letters_of(*word))
                return refuse(fmt::format("'{}' must be {}, not {}; try: {}", key_.name, kinds,
                                          in_quotes(*word), here));
        refuse(fmt::format("'{}' must be {}, not {}{}", key_.name, kinds, in_quotes(*word),
                           guess(*word, key_.words, '"')));
    }
    void check_words() {
        check_type<Values>();
        if (setting_.is_wrong) return;
        const Values& words = std::get<Values>(setting_.value.data);
        if (static_cast<double>(words.size()) < key_.range.low)
            refuse(fmt::format("'{}' is empty; it takes {}", key_.name, words_text(key_.words)));
        for (std::size_t i = 0; i < words.size() && !setting_.is_wrong; ++i) {
            check_word(words[i]);
            for (std::size_t k = 0; k < i && !setting_.is_wrong; ++k)
                if (words[i] == words[k])
                    refuse(fmt::format("'{}' has {} twice", key_.name, value_text(words[i])));
        }
    }

    void check_rows() {
        check_type<Values>();
        if (setting_.is_wrong) return;
        if (key_.is_one_row) {
            Values& rows = std::get<Values>(setting_.value.data);
            if (!rows.empty() && !std::holds_alternative<Values>(rows[0].data))
                rows = Values{Value{std::exchange(rows, {}), setting_.value.line}};
            if (rows.size() != 1) return refuse_type();
        }
        const std::size_t n_problems = problems_.size();
        std::size_t number = 0, n_wrong = 0;
        for (Value& row : std::get<Values>(setting_.value.data)) {
            const std::string name = fmt::format("row {} of '{}'", ++number, key_.name);
            const std::size_t n_before = problems_.size();
            Numbers numbers = key_.kind == Kind::rows ? numbers_of_row(row, name)
                                                      : numbers_of_table(row, name);
            const bool is_wrong = problems_.size() > n_before;
            if (is_wrong && ++n_wrong > most_wrong_rows) problems_.resize(n_before);
            row.data = std::monostate{};
            if (!is_wrong) row.data = std::move(numbers);
        }
        if (n_wrong > most_wrong_rows)
            refuse(fmt::format("and {} more wrong rows of '{}'", n_wrong - most_wrong_rows,
                               key_.name));
        setting_.is_wrong = problems_.size() > n_problems;
    }
    Numbers numbers_of_row(const Value& row, const std::string& name) {
        return numbers_of_field(row, key_.fields[0], name, row.line);
    }
    Numbers numbers_of_field(const Value& value, const Field& field, const std::string& name,
                             std::int64_t line) {
        if (!field.words.empty()) return number_of_word(value, field, name, line);
        Numbers numbers;
        const auto* list = std::get_if<Values>(&value.data);
        const std::size_t n = list ? list->size() : 1;
        for (std::size_t i = 0; i < n; ++i)
            if (const auto number = as_number(list ? (*list)[i] : value))
                numbers.push_back(*number);
        const bool takes_list = field.most > 1;
        if (numbers.size() == n && n >= field.least && n <= field.most &&
            (list != nullptr) == takes_list)
            return numbers;
        refuse_at(line,
                  fmt::format("{} must be {}", name,
                              takes_list ? "numbers, " + std::string(field.form) : "a number"));
        return {};
    }
    /// The index of the value's word in `field.words`, as a list of one number.
    Numbers number_of_word(const Value& value, const Field& field, const std::string& name,
                           std::int64_t line) {
        const auto* flag = std::get_if<bool>(&value.data);
        if (field.is_flag() && flag) return {*flag ? 1.0 : 0.0};
        const auto* word = field.is_flag() ? nullptr : std::get_if<std::string>(&value.data);
        for (std::size_t k = 0; word && k < field.words.size(); ++k)
            if (field.words[k] == *word) return {static_cast<double>(k)};
        refuse_at(line, fmt::format("{} must be {}, not {}{}", name,
                                    field.is_flag() ? "true or false" : words_text(field.words),
                                    value_text(value), word ? guess(*word, field.words, '"') : ""));
        return {};
    }
    std::string hint_of(const std::string& word, const std::vector<std::string_view>& names) const {
        const std::string instead = instead_of(fmt::format("{}.{}", key_.name, word));
        return instead.empty() ? guess(word, names, '\'') : "; " + instead;
    }
    Numbers numbers_of_table(const Value& row, const std::string& name) {
        const auto* table = std::get_if<NamedValues>(&row.data);
        if (!table) {
            refuse_at(row.line, fmt::format("{} must be a table", name));
            return {};
        }
        std::vector<std::string_view> names;
        for (const Field& field : key_.fields) names.push_back(field.name);
        for (const auto& [word, value] : *table)
            if (std::find(names.begin(), names.end(), word) == names.end())
                refuse_at(value.line, fmt::format("{} has no {}{}", name, in_quotes(word),
                                                  hint_of(word, names)));
        Numbers all;
        for (const Field& field : key_.fields) {
            const auto found = std::find_if(
                table->begin(), table->end(),
                [&field](const auto& one) { return one.first == field.name; });
            if (found != table->end()) {
                const Numbers numbers = numbers_of_field(found->second, field,
                                                         fmt::format("{}: {}", name, field.name),
                                                         found->second.line);
                all.insert(all.end(), numbers.begin(), numbers.end());
                // NaN would mean that the number is missing.
                if (field.fallback &&
                    std::ranges::any_of(numbers, [](double x) { return std::isnan(x); }))
                    refuse_at(found->second.line,
                              fmt::format("{}: {} must be a number, not nan", name, field.name));
            } else if (field.fallback) {
                all.insert(all.end(), field.most, *field.fallback);
            } else {
                refuse_at(row.line, fmt::format("{} needs {} = {}", name, field.name,
                                                field.form.empty() ? "..." : field.form));
            }
        }
        return all;
    }

    const Key& key_;
    Setting& setting_;
    Problems& problems_;
};

} // namespace

void check_value(const Key& key, Setting& setting, Problems& problems) {
    ValueCheck(key, setting, problems).check();
}

std::string number_text(double number) {
    int exponent = 0;
    if (std::frexp(std::fabs(number), &exponent) == 0.5 && std::abs(exponent) > 30)
        return fmt::format("{}2^{}", number < 0 ? "-" : "", exponent - 1);
    return fmt::format("{}", number);
}

std::string decimal_text(double number) {
    return number == 0 && std::signbit(number) ? "-0.0" : fmt::format("{}", number);
}

std::string range_text(const Range& range) {
    std::string text;
    if (std::isfinite(range.low) && std::isfinite(range.high) && !range.excludes_low)
        text = fmt::format("from {} to {}", number_text(range.low), number_text(range.high));
    else if (std::isfinite(range.low))
        text = fmt::format("{} {}", range.excludes_low ? "greater than" : "at least",
                           number_text(range.low)) +
               (std::isfinite(range.high) ? " and at most " + number_text(range.high) : "");
    return (range.allows_zero ? "0, or " : "") + text;
}

std::string words_text(const std::vector<std::string_view>& words) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i)
        list += fmt::format("{}\"{}\"",
                            i == 0                  ? ""
                            : i + 1 == words.size() ? " or "
                                                    : ", ",
                            words[i]);
    return list;
}

std::string kind_text(const Key& key) {
    const std::string bounds = range_text(key.range), range = bounds.empty() ? "" : ' ' + bounds;
    switch (key.kind) {
    case Kind::number: return "a number" + range;
    case Kind::lengths: return fmt::format("a number{}, or two, [Lx, Ly]", range);
    case Kind::point: return words_text(key.words) + ", or two numbers, [x, y]";
    case Kind::integer: return "a whole number" + range;
    case Kind::flag: return "true or false";
    case Kind::text: return "text";
    case Kind::choice: return words_text(key.words);
    case Kind::words: return "an array of " + words_text(key.words);
    case Kind::rows:
        return (key.is_one_row ? "numbers, " : "an array of ") + std::string(key.fields[0].form);
    case Kind::tables: return "an array of tables, [[" + key.name + "]]";
    }
    return {};
}

} // namespace carrom

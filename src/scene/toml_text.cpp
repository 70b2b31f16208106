// SPDX-License-Identifier: BSD-3-Clause
#include "scene/toml_text.hpp"

#include <cmath>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "scene/checked_value.hpp"
#include "scene/unknown_key.hpp"

namespace carrom {

namespace {

/// Limits the parts of a key, because the parser recurses for each part; scenes need three.
constexpr int most_parts = 32;
constexpr std::size_t most_unknown = 20; ///< unknown keys beyond this number are only counted

std::int64_t line_of(const toml::source_region& source) {
    return static_cast<std::int64_t>(source.begin.line);
}

Value to_value(const toml::node& node) {
    Value value;
    value.line = line_of(node.source());
    if (const auto* flag = node.as_boolean()) value.data = flag->get();
    if (const auto* integer = node.as_integer()) value.data = integer->get();
    if (const auto* number = node.as_floating_point()) value.data = number->get();
    if (const auto* text = node.as_string()) value.data = text->get();
    if (const auto* array = node.as_array()) {
        Values& values = value.data.emplace<Values>();
        for (const toml::node& one : *array) values.push_back(to_value(one));
    }
    if (const auto* table = node.as_table()) {
        NamedValues& values = value.data.emplace<NamedValues>();
        for (const auto& [name, one] : *table) {
            values.emplace_back(name.str(), to_value(one));
            values.back().second.line = line_of(name.source());
        }
    }
    return value;
}

/// The position after a string that begins at `at`. A string that is not closed ends with its line,
/// or with the text if it began with three quotes.
std::size_t end_of_string(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
    const std::string_view mark = text.substr(at, 3) == three ? three : text.substr(at, 1);
    for (at += mark.size(); at < text.size(); ++at) {
        if (text[at] == '\\' && quote == '"')
            ++at;
        else if (text.substr(at).starts_with(mark))
            return std::min(text.find_first_not_of(quote, at + mark.size()), text.size());
        else if (text[at] == '\n' && mark.size() == 1)
            return at;
    }
    return text.size();
}

/// The first line with a key of more than `most_parts` parts, or 0 if there is none.
std::int64_t line_of_deep_key(std::string_view text) {
    std::int64_t line = 1;
    int n_parts = 1;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (c == '"' || c == '\'') {
            const std::size_t end = end_of_string(text, at);
            line += std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                               text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
            at = end - 1;
        } else if (c == '#') {
            at = std::min(text.find('\n', at), text.size()) - 1;
        } else if (c == '.') {
            if (++n_parts > most_parts) return line;
        } else if (c == '\n' || c == '=' || c == ',' || c == '{' || c == '[') {
            n_parts = 1;
            line += c == '\n';
        }
    }
    return 0;
}

class Walk {
public:
    Walk(Settings& settings, Problems& problems, const std::string& name)
        : settings_(settings), problems_(problems), name_(name) {}

    void walk(const toml::table& table, const std::string& prefix = "") {
        for (const auto& [name, node] : table)
            take(prefix + std::string(name.str()), node, line_of(name.source()));
    }
    void count_unknown() {
        if (n_unknown_ > most_unknown)
            add_problem(problems_, {name_, 0},
                        fmt::format("and {} more unknown keys", n_unknown_ - most_unknown));
    }

private:
    void take(const std::string& key, const toml::node& node, std::int64_t line) {
        const Table* table = find_table(key);
        const bool is_table = table && node.is_table();
        if (find_key(key) && !is_table) {
            Value value = to_value(node);
            const Place place{name_, value.line};
            settings_.set({key, place, std::move(value)});
        } else if (is_table) {
            if (!find_key(key)) settings_.set({key, {name_, line}, {}});
            walk(*node.as_table(), key + '.');
        } else if (table) {
            add_problem(problems_, {name_, line}, table_text(key, to_value(node)));
        } else if (++n_unknown_ <= most_unknown) {
            add_problem(problems_, {name_, line},
                        unknown_key_text(key, node.is_value() ? to_value(node) : Value{}));
        }
    }

    Settings& settings_;
    Problems& problems_;
    const std::string& name_;
    std::size_t n_unknown_ = 0;
};

/// Removes line numbers, because values of `--set` have no lines.
void forget_lines(Value& value) {
    value.line = 0;
    if (auto* values = std::get_if<Values>(&value.data))
        for (Value& one : *values) forget_lines(one);
    if (auto* values = std::get_if<NamedValues>(&value.data))
        for (auto& [name, one] : *values) forget_lines(one);
}

/// Parses a value of `--set`; returns nothing if the text is not a value.
std::optional<Value> parse_any(const std::string& text) {
    const std::string line = "value = " + text;
    if (text.find('\n') != std::string::npos || line_of_deep_key(line) > 0) return std::nullopt;
    try {
        Value value = to_value(*toml::parse(line).get("value"));
        forget_lines(value);
        return value;
    } catch (const toml::parse_error&) {
        return std::nullopt;
    }
}

std::string quoted_text(const std::string& text) {
    std::string all = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') all += '\\';
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            all += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            all += c;
    }
    return all + '"';
}

std::string numbers_text(Numbers::const_iterator first, std::size_t n) {
    std::string list;
    for (std::size_t i = 0; i < n; ++i)
        list += fmt::format("{}{}", i == 0 ? "" : ", ", decimal_text(first[static_cast<int>(i)]));
    return list;
}

std::string word_text(const Field& field, double number) {
    const std::string word{field.words[static_cast<std::size_t>(number)]};
    return field.is_flag() ? word : quoted_text(word);
}

std::string row_text(const Key& key, const Numbers& numbers) {
    if (key.kind == Kind::rows || key.kind == Kind::lengths || key.kind == Kind::point)
        return '[' + numbers_text(numbers.begin(), numbers.size()) + ']';
    std::string text;
    auto next = numbers.begin();
    for (const Field& field : key.fields) {
        const std::string list = field.words.empty() ? numbers_text(next, field.most)
                                                     : word_text(field, *next);
        const bool is_none = field.fallback && std::isnan(*field.fallback) && std::isnan(*next);
        next += static_cast<std::ptrdiff_t>(field.most);
        if (is_none) continue;
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", field.name,
                            field.most > 1 ? '[' + list + ']' : list);
    }
    return "{" + text + "}";
}

} // namespace

bool add_toml(Settings& settings, Problems& problems, std::string_view text,
              const std::string& name) {
    if (const std::int64_t line = line_of_deep_key(text)) {
        add_problem(
            problems, {name, line},
            fmt::format("a key of more than {} parts; keys have three at most", most_parts));
        return false;
    }
    try {
        Walk walk(settings, problems, name);
        walk.walk(toml::parse(text));
        walk.count_unknown();
        return true;
    } catch (const toml::parse_error& error) {
        add_problem(problems, {name, line_of(error.source())},
                    "not valid TOML: " + std::string(error.description()));
        return false;
    }
}

std::optional<Value> parse_value(const Key& key, const std::string& text) {
    const bool is_list = key.kind == Kind::point && text.starts_with('[');
    const bool takes_word = key.kind == Kind::text || key.kind == Kind::choice ||
                            (key.kind == Kind::point && !is_list);
    const bool is_quoted = !text.empty() && (text[0] == '"' || text[0] == '\'');
    if (takes_word && !is_quoted) return Value{text};
    return parse_any(text);
}

std::optional<NamedValues> parse_table(const std::string& text) {
    auto value = parse_any(text);
    auto* values = value ? std::get_if<NamedValues>(&value->data) : nullptr;
    if (!values) return std::nullopt;
    return std::move(*values);
}

std::string toml_text(const Key& key, const Value& value) {
    if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
    if (const auto* integer = std::get_if<std::int64_t>(&value.data))
        return fmt::format("{}", *integer);
    if (const auto* number = std::get_if<double>(&value.data)) return decimal_text(*number);
    if (const auto* text = std::get_if<std::string>(&value.data)) return quoted_text(*text);
    if (const auto* numbers = std::get_if<Numbers>(&value.data)) return row_text(key, *numbers);
    const auto* values = std::get_if<Values>(&value.data);
    if (!values) return "none";
    std::string list;
    for (const Value& one : *values)
        list += key.has_rows() ? "\n  " + toml_text(key, one) + ',' : toml_text(key, one) + ", ";
    if (!key.has_rows() && !list.empty()) list.resize(list.size() - 2);
    return '[' + list + (key.has_rows() && !list.empty() ? "\n]" : "]");
}

} // namespace carrom

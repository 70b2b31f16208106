// SPDX-License-Identifier: BSD-3-Clause
#include "scene/legacy_header.hpp"

#include <array>
#include <optional>

#include <fmt/format.h>

#include "scene/number.hpp"

namespace carrom {

namespace {

struct Entry {
    std::string_view key;
    std::string_view meaning;
    bool is_integer;
};

constexpr std::array<Entry, legacy_header_lines> entries = {
    {{"discs.count", "N, the number of discs", true},
     {"box.size", "L, the side of the box", false},
     {"discs.radius", "r, the radius of a disc", false},
     {"time.steps", "S, the number of steps", true},
     {"output.text", "'print' or 'perf'", false}}};

/// The word as the entry's value; nothing if it is not valid.
std::optional<Value> value_of(const Entry& entry, std::string_view word) {
    if (entry.key == "output.text") {
        if (word == "print") return Value{std::string("every_step")};
        if (word == "perf") return Value{std::string("ends")};
        return std::nullopt;
    }
    const auto integer = parse_integer(word);
    if (entry.is_integer && integer) return Value{*integer};
    const auto number = parse_double(word);
    return number ? std::optional(Value{*number}) : std::nullopt;
}

void add_entry(Settings& settings, Problems& problems, const Entry& entry, std::string_view word,
               const Place& place) {
    auto value = value_of(entry, word);
    if (!value)
        return add_problem(problems, place,
                           fmt::format("expected {}, not {}", entry.meaning, in_quotes(word)));
    value->line = place.line;
    settings.set({std::string(entry.key), place, std::move(*value)});
}

} // namespace

void add_legacy_header(Settings& settings, Problems& problems, std::string_view text,
                       const std::string& name, bool discs_follow) {
    Place place{name, 0};
    for (const Entry& entry : entries) // marks entries as wrong until they are found
        settings.set({std::string(entry.key), place, {}, true});
    std::size_t found = 0;
    while (!text.empty() && found < entries.size()) {
        const std::size_t end = text.find('\n');
        const std::string_view line = trimmed(text.substr(0, end));
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
        place.line += 1;
        if (line.empty()) continue;
        const Entry& entry = entries[found++];
        const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
        add_entry(settings, problems, entry, word, place);
        if (word.size() < line.size())
            add_problem(problems, place,
                        fmt::format("{} after {}", in_quotes(trimmed(line.substr(word.size()))),
                                    entry.meaning));
    }
    if (found == 0)
        add_problem(problems, {name, 0},
                    "the input is empty; expected N, L, r, S and 'print' or 'perf', one per line");
    else if (found == entries.size() - 1 && discs_follow)
        settings.set({"output.text", place, {std::string("ends")}});
    else if (found < entries.size())
        add_problem(problems, place,
                    fmt::format("the input ends before {}", entries[found].meaning));
    settings.set({"discs.generator", place, {std::string(discs_follow ? "file" : "legacy")}});
    // The method of the course program
    settings.set({"time.method", place, {std::string("time-stepped")}});
}

} // namespace carrom

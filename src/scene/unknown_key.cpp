// SPDX-License-Identifier: BSD-3-Clause
#include "scene/unknown_key.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "scene/key.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

/// The place of the nearest name, if it is near enough to have been meant.
std::optional<std::size_t> nearest_of(std::string_view name,
                                      std::span<const std::string_view> names) {
    name = name.substr(0, 200);
    std::size_t least = std::min(std::max<std::size_t>(1, name.size() / 3) + 1,
                                 name.size()); // at least one letter must be right
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::size_t distance = edit_distance(name, names[i]);
        if (distance >= least) continue;
        least = distance;
        nearest = i;
    }
    return nearest;
}

std::string_view table_of(std::string_view key) {
    const std::size_t dot = key.rfind('.');
    return key.substr(0, dot == std::string_view::npos ? 0 : dot);
}

std::string_view last_of(std::string_view key) { return key.substr(key.rfind('.') + 1); }

/// Names of keys and tables: those of a known table, else all of them.
std::vector<std::string_view> names_in(std::string_view table, bool is_known) {
    std::vector<std::string_view> names;
    for (const Key& one : keys())
        if (!is_known || one.table() == table) names.push_back(one.name);
    for (const Table& one : tables())
        if (!is_known || table_of(one.name) == table) names.push_back(one.name);
    return names;
}

/// The names that the innermost existing table has.
std::string what_there_is(std::string_view table) {
    while (!table.empty() && !find_table(table)) table = table_of(table);
    if (table.empty())
        return "; keys stand in the tables [box], [discs], [time], [effects] and [output]";
    std::string list;
    for (const std::string_view name : names_in(table, true))
        list += (list.empty() ? "" : ", ") + std::string(last_of(name));
    return fmt::format("; [{}] has {}", table, list);
}

std::string renamed_text(const Key& key, std::string_view old, const Value& value) {
    std::string text = fmt::format("'{}' is now '{}'", old, key.name);
    const auto* word = std::get_if<std::string>(&value.data);
    for (const auto& [old_word, new_word] : key.old_words)
        if (word && *word == old_word)
            text += fmt::format("; write {} = \"{}\" for \"{}\"", key.name, new_word, old_word);
    return text;
}

} // namespace

std::string unknown_key_text(std::string_view key, const Value& value) {
    for (const Key& known : keys())
        if (!known.old_name.empty() && known.old_name == key)
            return renamed_text(known, key, value);
    for (const std::string_view old : {"output.checkpoint.folder", "output.trajectory.file",
                                       "output.collisions.file", "output.measurements.folder"})
        if (key == old)
            return in_quotes(key) +
                   " is no more: name 'output.folder', where all that a run writes "
                   "has its place";
    if (key == "box.periodic")
        return "no such key 'box.periodic'; try: box.left.kind = \"periodic\" and "
               "box.right.kind = \"periodic\", and the same of bottom and top";
    if (key == "discs.polydispersity")
        return "no such key 'discs.polydispersity'; try: discs.radius.distribution = "
               "\"lognormal\" and discs.radius.polydispersity";
    if (find_table(key)) return in_quotes(key) + " is a table, not a value";
    const std::string_view table = table_of(key);
    const bool is_known = !table.empty() && find_table(table);
    const std::vector<std::string_view> names = names_in(table, is_known);
    std::vector<std::string_view> compared = names;
    if (is_known || table.empty()) // a key without a table, whose table may have been forgotten
        std::transform(names.begin(), names.end(), compared.begin(), last_of);
    const auto nearest = nearest_of(is_known ? last_of(key) : key, compared);
    return "no such key " + in_quotes(key) +
           (nearest ? fmt::format("; did you mean '{}'?", names[*nearest]) : what_there_is(table));
}

std::string guess(std::string_view name, std::span<const std::string_view> names, char quote) {
    const auto nearest = nearest_of(name, names);
    return nearest ? fmt::format("; did you mean {}{}{}?", quote, names[*nearest], quote) : "";
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1), last, before_last;
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        before_last = std::exchange(last, row);
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            row[j + 1] = std::min({last[j] + (a[i] != b[j]), last[j + 1] + 1, row[j] + 1});
            const bool are_swapped = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
            if (are_swapped) row[j + 1] = std::min(row[j + 1], before_last[j - 1] + 1);
        }
    }
    return row[b.size()];
}

} // namespace carrom

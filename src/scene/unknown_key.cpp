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

/// The index of the name that is most similar to `name`, or nothing if none is similar enough.
std::optional<std::size_t> nearest_of(std::string_view name,
                                      std::span<const std::string_view> names) {
    name = name.substr(0, 200);
    std::size_t least = std::min(std::max<std::size_t>(1, name.size() / 3) + 1,
                                 name.size()); // at least one letter must be correct
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::size_t distance = edit_distance(name, names[i]);
        if (distance >= least) continue;
        least = distance;
        nearest = i;
    }
    return nearest;
}

constexpr std::string_view folder_text =
    "it is no more: name 'output.folder', where all that a run writes has its place";
constexpr std::string_view both_partners =
    "it is of pairs; try: effects.contact.restitution for all, and [[effects.contact.pairs]] with "
    "species = [1, 2] for others; walls have box.bottom.contacts";

std::string_view table_of(std::string_view key) {
    const std::size_t dot = key.rfind('.');
    return key.substr(0, dot == std::string_view::npos ? 0 : dot);
}

std::string_view last_of(std::string_view key) { return key.substr(key.rfind('.') + 1); }

/// Names of the keys and tables in `table`. If the table is unknown, all names: those with fewer
/// dots come first, because among equally near names the outer one is meant more often.
std::vector<std::string_view> names_in(std::string_view table, bool is_known) {
    std::vector<std::string_view> names;
    for (const Key& one : keys())
        if (!is_known || one.table() == table) names.push_back(one.name);
    for (const Table& one : tables())
        if (!is_known || table_of(one.name) == table) names.push_back(one.name);
    if (!is_known)
        std::ranges::stable_sort(
            names, {}, [](std::string_view name) { return std::ranges::count(name, '.'); });
    return names;
}

/// Text that lists the names in `table`, or in the next outer table if `table` does not exist.
std::string what_there_is(std::string_view table) {
    while (!table.empty() && !find_table(table)) table = table_of(table);
    if (table.empty())
        return "; keys stand in the tables [box], [discs], [time], [effects] and [output]";
    std::string list;
    for (const std::string_view name : names_in(table, true))
        list += (list.empty() ? "" : ", ") + std::string(last_of(name));
    return fmt::format("; [{}] has {}", table, list);
}

/// Keys that users may expect but Carrom lacks, and the advice for each.
constexpr std::pair<std::string_view, std::string_view> keys_tried[] = {
    {"output.checkpoint.folder", folder_text},
    {"output.trajectory.file", folder_text},
    {"output.collisions.file", folder_text},
    {"output.measurements.folder", folder_text},
    {"box.periodic", "try: box.left.kind = \"periodic\" and box.right.kind = \"periodic\", and the "
                     "same of bottom and top"},
    {"discs.polydispersity",
     "try: discs.radius.distribution = \"lognormal\" and discs.radius.polydispersity"},
    {"discs.mass", "a disc has the mass 1, which is the unit; discs.species = [{count = N, radius "
                   "= r, mass = m}] in place of discs.radius gives others"},
    {"discs.density", "try: discs.packing, the share of the box that discs cover, or discs.count"},
    {"discs.N", "try: discs.count"},
    {"discs.n", "try: discs.count"},
    {"discs.number", "try: discs.count"},
    {"discs.species.restitution", both_partners},
    {"discs.species.friction", both_partners},
    {"time.dt", "a step is the unit of time, and collisions come at their exact times; try: "
                "time.steps, and speeds in lengths per step"},
    {"time.timestep",
     "a step is the unit of time; try: time.steps, and speeds in lengths per step"},
    {"time.collisions", "try: time.stop.collisions, which ends a run by their number; time.method "
                        "is how they are found"},
    {"time.stop.kT", "try: time.stop.kT_below or time.stop.kT_above"},
    {"time.stop.temperature", "try: time.stop.kT_below or time.stop.kT_above"},
    {"time.stop.energy", "try: time.stop.energy_below or time.stop.energy_above"},
    {"time.stop.pressure", "try: time.stop.pressure_below or time.stop.pressure_above"},
};

/// Whether the value may have been valid under the key's old name. A number was not valid if the
/// old key took words.
bool is_old_value(const Key& key, const Value& value) {
    const auto* word = std::get_if<std::string>(&value.data);
    return key.words.empty() || (word ? !parse_double(*word) : value.is_nothing());
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
        if (!known.old_name.empty() && known.old_name == key && is_old_value(known, value))
            return renamed_text(known, key, value);
    if (const std::string text = instead_of(key); !text.empty())
        return fmt::format("no such key {}; {}", in_quotes(key), text);
    if (find_table(key)) return table_text(key, value);
    const std::string_view table = table_of(key);
    const bool is_known = !table.empty() && find_table(table);
    const std::vector<std::string_view> names = names_in(table, is_known);
    std::vector<std::string_view> compared = names;
    if (is_known || table.empty()) // the user may have left out the table
        std::transform(names.begin(), names.end(), compared.begin(), last_of);
    const auto nearest = nearest_of(is_known ? last_of(key) : key, compared);
    return "no such key " + in_quotes(key) +
           (nearest ? fmt::format("; did you mean '{}'?", names[*nearest]) : what_there_is(table));
}

std::string instead_of(std::string_view key) {
    for (const auto& [tried, text] : keys_tried)
        if (tried == key) return std::string(text);
    return {};
}

std::string table_text(std::string_view key, const Value& value) {
    const std::string text = fmt::format("'{}' is a table, not a value", key);
    const auto try_key = [&](std::string_view name, const std::string& shown) {
        return fmt::format("{}; try: {}.{} = {}", text, key, name, shown);
    };
    const Key* kind = find_key(fmt::format("{}.kind", key));
    const auto* word = std::get_if<std::string>(&value.data);
    const auto is_word = [word](std::string_view one) { return one == *word; };
    if (kind && word && std::ranges::any_of(kind->words, is_word))
        return try_key("kind", fmt::format("\"{}\"", *word));
    const auto* real = std::get_if<double>(&value.data);
    const auto* whole = std::get_if<std::int64_t>(&value.data);
    const std::string number = real                          ? fmt::format("{:g}", *real)
                               : whole                       ? fmt::format("{}", *whole)
                               : word && parse_double(*word) ? *word
                                                             : "";
    if (!number.empty() && key == "effects.gravity") // y is negative: gravity pulls downwards
        return try_key("y", number.starts_with('-') ? number : "-" + number);
    return text + what_there_is(key);
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

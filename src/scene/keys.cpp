// SPDX-License-Identifier: BSD-3-Clause
#include "scene/keys.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "scene/number.hpp"

namespace carrom {

namespace {

struct Key {
    std::string_view name;
    ValueKind kind;
};

constexpr std::array keys = {
    Key{"box.size", ValueKind::number},
    Key{"discs.count", ValueKind::integer},
    Key{"discs.radius", ValueKind::number},
    Key{"discs.packing", ValueKind::number},
    Key{"discs.generator", ValueKind::text},
    Key{"discs.file", ValueKind::text},
    Key{"discs.list", ValueKind::rows},
    Key{"discs.speed", ValueKind::number},
    Key{"discs.velocities", ValueKind::text},
    Key{"discs.seed", ValueKind::integer},
    Key{"discs.streams", ValueKind::streams},
    Key{"discs.species", ValueKind::species},
    Key{"discs.columns", ValueKind::words},
    Key{"time.steps", ValueKind::integer},
    Key{"time.method", ValueKind::text},
    Key{"time.micro_steps", ValueKind::integer},
    Key{"time.sync_every", ValueKind::integer},
    Key{"time.accuracy", ValueKind::number},
    Key{"time.precision", ValueKind::text},
    Key{"time.arithmetic", ValueKind::text},
    Key{"time.contraction", ValueKind::flag},
    Key{"box.left.kind", ValueKind::text},
    Key{"box.left.restitution", ValueKind::number},
    Key{"box.left.temperature", ValueKind::number},
    Key{"box.left.speed", ValueKind::number},
    Key{"box.right.kind", ValueKind::text},
    Key{"box.right.restitution", ValueKind::number},
    Key{"box.right.temperature", ValueKind::number},
    Key{"box.right.speed", ValueKind::number},
    Key{"box.bottom.kind", ValueKind::text},
    Key{"box.bottom.restitution", ValueKind::number},
    Key{"box.bottom.temperature", ValueKind::number},
    Key{"box.bottom.speed", ValueKind::number},
    Key{"box.top.kind", ValueKind::text},
    Key{"box.top.restitution", ValueKind::number},
    Key{"box.top.temperature", ValueKind::number},
    Key{"box.top.speed", ValueKind::number},
    Key{"effects.gravity.x", ValueKind::number},
    Key{"effects.gravity.y", ValueKind::number},
    Key{"effects.drag.rate", ValueKind::number},
    Key{"effects.thermal.seed", ValueKind::integer},
    Key{"effects.contact.kind", ValueKind::text},
    Key{"effects.contact.restitution", ValueKind::number},
    Key{"effects.contact.tangential_restitution", ValueKind::number},
    Key{"effects.contact.friction", ValueKind::number},
    Key{"effects.contact.moment_of_inertia", ValueKind::number},
    Key{"effects.contact.contact_time", ValueKind::number},
    Key{"effects.obstacles.discs", ValueKind::fixed_discs},
    Key{"effects.obstacles.segments", ValueKind::segments},
    Key{"effects.obstacles.restitution", ValueKind::number},
    Key{"output.text", ValueKind::text},
    Key{"output.folder", ValueKind::text},
    Key{"output.checkpoint.every_steps", ValueKind::integer},
    Key{"output.checkpoint.every_minutes", ValueKind::number},
    Key{"output.checkpoint.keep", ValueKind::integer},
    Key{"output.checkpoint.at_end", ValueKind::flag},
    Key{"output.trajectory.every_steps", ValueKind::integer},
    Key{"output.trajectory.fields", ValueKind::words},
    Key{"output.trajectory.precision", ValueKind::text},
    Key{"output.collisions", ValueKind::flag},
    Key{"output.measurements.quantities", ValueKind::words},
    Key{"output.measurements.every_steps", ValueKind::integer},
    Key{"output.measurements.from_step", ValueKind::integer},
    Key{"output.measurements.bins", ValueKind::integer},
    Key{"output.measurements.largest_distance", ValueKind::number},
    Key{"output.measurements.largest_velocity", ValueKind::number},
};

constexpr std::array<std::string_view, 17> tables = {"box",
                                                     "discs",
                                                     "time",
                                                     "output",
                                                     "output.checkpoint",
                                                     "output.trajectory",
                                                     "output.measurements",
                                                     "effects",
                                                     "effects.contact",
                                                     "effects.gravity",
                                                     "effects.drag",
                                                     "effects.thermal",
                                                     "effects.obstacles",
                                                     "box.left",
                                                     "box.right",
                                                     "box.bottom",
                                                     "box.top"};

std::string_view part_after(std::string_view key, std::size_t dot) {
    return key.substr(dot + 1, key.find('.', dot + 1) - dot - 1);
}

/// The place of the nearest name, if it is near enough to have been meant.
std::optional<std::size_t> nearest_of(std::string_view name,
                                      std::span<const std::string_view> names) {
    name = name.substr(0, 200);
    std::size_t least = std::min(std::max<std::size_t>(1, name.size() / 3) + 1,
                                 name.size()); // not every letter replaced
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::size_t distance = edit_distance(name, names[i]);
        if (distance >= least) continue;
        least = distance;
        nearest = i;
    }
    return nearest;
}

/// "; [time] has steps, collisions, ...", or the tables where `key` is in none.
std::string what_there_is(std::string_view key) {
    const std::size_t dot = key.rfind('.');
    const std::string table{key.substr(0, dot == std::string_view::npos ? 0 : dot)};
    std::string list;
    for (const Key& known : keys)
        if (!table.empty() && known.name.starts_with(table + '.') &&
            known.name.find('.', table.size() + 1) == std::string_view::npos)
            list += (list.empty() ? "" : ", ") + std::string(known.name.substr(table.size() + 1));
    if (list.empty())
        return "; keys stand in the tables [box], [discs], [time], [effects] and [output]";
    return "; [" + table + "] has " + list;
}

/// In a table that there is, the name alone is compared, with that table's; a key without a table
/// also with keys whose table was forgotten.
std::string no_such_key(std::string_view key) {
    const std::size_t dot = key.rfind('.');
    const bool has_table = dot != std::string_view::npos;
    const std::string_view table = key.substr(0, has_table ? dot : 0);
    std::vector<std::string_view> names, compared;
    if (!has_table) names = compared = {"box", "discs", "time", "output", "effects"};
    for (const Key& known : keys) {
        const std::size_t known_dot = known.name.rfind('.');
        if (is_table(table) && known.name.substr(0, known_dot) != table) continue;
        names.push_back(known.name);
        compared.push_back(has_table && !is_table(table) ? known.name
                                                         : known.name.substr(known_dot + 1));
    }
    const auto nearest = nearest_of(is_table(table) ? key.substr(dot + 1) : key, compared);
    return "no such key " + quoted(key) +
           (nearest ? "; did you mean '" + std::string(names[*nearest]) + "'?"
                    : what_there_is(key));
}

} // namespace

std::optional<ValueKind> kind_of_key(std::string_view key) {
    for (const Key& known : keys)
        if (known.name == key) return known.kind;
    return std::nullopt;
}

bool is_table(std::string_view key) {
    return std::find(tables.begin(), tables.end(), key) != tables.end();
}

bool has_meaning_for(std::string_view generator, std::string_view key) {
    const bool lists = key == "discs.file" || key == "discs.list" || key == "discs.columns";
    const bool speeds = key == "discs.speed" || key == "discs.velocities";
    const bool random = key == "discs.seed" || key == "discs.streams";
    if (generator == "file") return !speeds && !random;
    if (generator == "legacy") return !lists && !speeds && key != "discs.species";
    return !lists;
}

std::string unknown_key_text(std::string_view key) {
    for (const std::string_view old : {"output.checkpoint.folder", "output.trajectory.file",
                                       "output.collisions.file", "output.measurements.folder"})
        if (key == old)
            return quoted(key) +
                   " is no more: name 'output.folder', where all that a run writes "
                   "has its place" +
                   (old == "output.collisions.file" ? ", and set 'output.collisions' = true" : "");
    const std::size_t dot = key.find('.');
    const std::string_view table = key.substr(0, dot);
    if (table == "effects" || table == "output") {
        const std::string what = table == "effects" ? "effect" : "output";
        const std::size_t second_dot = dot == std::string_view::npos ? dot : key.find('.', dot + 1);
        if (second_dot != std::string_view::npos && is_table(key.substr(0, second_dot)))
            return no_such_key(key);
        if (dot == std::string_view::npos)
            return quoted(key) + " is a table of " + what + "s, not a value";
        if (is_table(key)) return quoted(key) + " is a table, not a value";
        const std::string_view name = part_after(key, dot);
        const bool is_misspelt = table == "output" && edit_distance(name, "text") <= 2;
        return "this version has no " + what + ' ' + quoted(name) +
               (is_misspelt ? "; did you mean 'output.text'?" : "");
    }
    return no_such_key(key);
}

std::string guess(std::string_view name, std::span<const std::string_view> names, char quote) {
    const auto nearest = nearest_of(name, names);
    return nearest
               ? std::string("; did you mean ") + quote + std::string(names[*nearest]) + quote + '?'
               : "";
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
        }
    }
    return row[b.size()];
}

} // namespace carrom

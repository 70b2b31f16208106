// SPDX-License-Identifier: BSD-3-Clause
#include "keys.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "number.hpp"

namespace carrom {

namespace {

struct Key {
    std::string_view name;
    ValueKind kind;
};

constexpr std::array keys = {
    Key{"box.size", ValueKind::number},          Key{"discs.count", ValueKind::integer},
    Key{"discs.radius", ValueKind::number},      Key{"discs.packing", ValueKind::number},
    Key{"discs.generator", ValueKind::text},     Key{"discs.file", ValueKind::text},
    Key{"discs.list", ValueKind::rows},          Key{"discs.speed", ValueKind::number},
    Key{"discs.velocities", ValueKind::text},    Key{"discs.seed", ValueKind::integer},
    Key{"discs.streams", ValueKind::streams},    Key{"time.steps", ValueKind::integer},
    Key{"time.collisions", ValueKind::text},     Key{"time.micro_steps", ValueKind::integer},
    Key{"time.sync_every", ValueKind::integer},  Key{"time.accuracy", ValueKind::number},
    Key{"time.precision", ValueKind::text},      Key{"time.arithmetic", ValueKind::text},
    Key{"time.contraction", ValueKind::flag},
    Key{"output.text", ValueKind::text},         Key{"output.checkpoint.folder", ValueKind::text},
    Key{"output.checkpoint.every_steps", ValueKind::integer},
    Key{"output.checkpoint.every_minutes", ValueKind::number},
    Key{"output.checkpoint.keep", ValueKind::integer},
    Key{"output.checkpoint.at_end", ValueKind::flag},
    Key{"output.trajectory.file", ValueKind::text},
    Key{"output.trajectory.every_steps", ValueKind::integer},
    Key{"output.trajectory.fields", ValueKind::words},
    Key{"output.trajectory.precision", ValueKind::text},
    Key{"output.trajectory.compression", ValueKind::integer},
    Key{"output.collisions.file", ValueKind::text},
};

constexpr std::array<std::string_view, 8> tables = {
    "box", "discs", "time", "output", "output.checkpoint", "output.trajectory", "output.collisions", "effects"};

std::string_view part_after(std::string_view key, std::size_t dot) { return key.substr(dot + 1, key.find('.', dot + 1) - dot - 1); }

/// Of a key without a table, the name is compared with the tables' names and with keys whose table was forgotten.
std::string nearest_key(std::string_view key) {
    const bool has_table = key.find('.') != std::string_view::npos;
    std::vector<std::string_view> names, compared;
    if (!has_table) names = compared = {"box", "discs", "time", "output", "effects"};
    for (const Key& known : keys) {
        names.push_back(known.name);
        compared.push_back(has_table ? known.name : known.name.substr(known.name.find('.') + 1));
    }
    const std::string nearest = nearest_of(key, compared.data(), compared.size());
    const auto found = std::find(compared.begin(), compared.end(), nearest);
    return std::string(names[static_cast<std::size_t>(found - compared.begin())]);
}

} // namespace

std::optional<ValueKind> kind_of_key(std::string_view key) {
    for (const Key& known : keys)
        if (known.name == key) return known.kind;
    return std::nullopt;
}

bool is_table(std::string_view key) { return std::find(tables.begin(), tables.end(), key) != tables.end(); }

bool has_meaning_for(std::string_view generator, std::string_view key) {
    const bool lists = key == "discs.file" || key == "discs.list";
    const bool speeds = key == "discs.speed" || key == "discs.velocities";
    const bool random = key == "discs.seed" || key == "discs.streams";
    if (generator == "file") return !speeds && !random;
    if (generator == "ancestor") return !lists && !speeds;
    return !lists;
}

std::string unknown_key_text(std::string_view key) {
    const std::size_t dot = key.find('.');
    const std::string_view table = key.substr(0, dot);
    if (table == "effects" || table == "output") {
        const std::string what = table == "effects" ? "effect" : "output";
        const std::size_t second_dot = dot == std::string_view::npos ? dot : key.find('.', dot + 1);
        if (second_dot != std::string_view::npos && is_table(key.substr(0, second_dot)))
            return "no such key " + quoted(key) + "; did you mean '" + nearest_key(key) + "'?";
        if (dot == std::string_view::npos) return quoted(key) + " is a table of " + what + "s, not a value";
        const std::string_view name = part_after(key, dot);
        const bool is_misspelt = table == "output" && edit_distance(name, "text") <= 2;
        return "this version has no " + what + ' ' + quoted(name) + (is_misspelt ? "; did you mean 'output.text'?" : "");
    }
    return "no such key " + quoted(key) + "; did you mean '" + nearest_key(key) + "'?";
}

std::string nearest_of(std::string_view name, const std::string_view* names, std::size_t n_names) {
    name = name.substr(0, 200);
    const auto* nearest = std::min_element(names, names + n_names, [name](std::string_view a, std::string_view b) {
        return edit_distance(name, a) < edit_distance(name, b);
    });
    return std::string(*nearest);
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

// SPDX-License-Identifier: BSD-3-Clause
#include "scene/toml_settings.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "scene/keys.hpp"
#include "scene/number.hpp"

namespace carrom {

namespace {

/// Where the walk stands: `place` serves where a node has no line of its own (`--set`).
struct Walk {
    Settings& settings;
    Problems& problems;
    Place place;
    bool has_lines;

    Place place_of(const toml::source_region& source) const {
        return {place.name, has_lines ? static_cast<std::int64_t>(source.begin.line) : place.line};
    }
};

std::string type_name(const toml::node& node) {
    switch (node.type()) {
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "an array";
    case toml::node_type::string: return "text";
    case toml::node_type::integer: return "a whole number";
    case toml::node_type::floating_point: return "a number";
    case toml::node_type::boolean: return "true or false";
    default: return "a date or time";
    }
}

std::string kind_name(ValueKind kind) {
    switch (kind) {
    case ValueKind::number: return "a number";
    case ValueKind::integer: return "a whole number";
    case ValueKind::text: return "text";
    case ValueKind::words: return "an array of texts";
    case ValueKind::flag: return "true or false";
    case ValueKind::rows: return "an array of [x, y, vx, vy] or [x, y, vx, vy, radius, mass]";
    case ValueKind::fixed_discs: return "an array of [x, y, radius]";
    case ValueKind::segments: return "an array of [x0, y0, x1, y1]";
    case ValueKind::streams: return "an array of tables, [[discs.streams]]";
    case ValueKind::species: return "an array of tables, [[discs.species]]";
    }
    return {};
}

std::string shown(const toml::node& node) {
    if (const auto* text = node.as_string()) return quoted(text->get());
    return type_name(node);
}

std::optional<double> as_number(const toml::node& node) {
    if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
    if (const auto* real = node.as_floating_point()) return real->get();
    return std::nullopt;
}

/// The numbers of an array of exactly `count`; otherwise a problem.
std::optional<std::vector<double>> numbers_of(Walk& walk, const toml::node& node, std::size_t count,
                                              const std::string& what) {
    std::vector<double> numbers;
    if (const auto* array = node.as_array())
        for (const toml::node& element : *array)
            if (const auto number = as_number(element)) numbers.push_back(*number);
    const auto* array = node.as_array();
    if (array && numbers.size() == count && array->size() == count) return numbers;
    add_problem(walk.problems, walk.place_of(node.source()), what);
    return std::nullopt;
}

std::vector<Row> rows_of(Walk& walk, const toml::array& array, const std::string& key,
                         std::size_t count, std::string_view numbers_wanted) {
    std::vector<Row> rows;
    for (const toml::node& node : array) {
        const std::size_t n = node.is_array() ? node.as_array()->size() : count;
        const bool has_more = key == "discs.list" && n > count &&
                              n <= 7; // spin, or radius and mass, or all three
        const auto numbers = numbers_of(
            walk, node, has_more ? n : count,
            fmt::format("row {} of '{}' must be {}", rows.size() + 1, key, numbers_wanted));
        rows.push_back({walk.place_of(node.source()), numbers.value_or(std::vector<double>{})});
    }
    return rows;
}

/// The `number`-th stream, from 1; nothing after a problem.
std::optional<StreamRows> stream_of(Walk& walk, const toml::table& table, std::size_t number) {
    const std::string name = fmt::format("stream {}", number);
    static constexpr std::array<std::string_view, 2> names = {"region", "velocity"};
    for (const auto& [key, node] : table)
        if (key.str() != names[0] && key.str() != names[1])
            add_problem(walk.problems, walk.place_of(key.source()),
                        fmt::format("{}: a stream has no {}{}", name, quoted(key.str()),
                                    guess(key.str(), names, '\'')));
    const toml::node* region = table.get("region");
    const toml::node* velocity = table.get("velocity");
    if (!region || !velocity) {
        add_problem(walk.problems, walk.place_of(table.source()),
                    name + " needs region = [x0, y0, x1, y1] and velocity = [vx, vy]");
        return std::nullopt;
    }
    auto corners = numbers_of(walk, *region, 4,
                              name + ": its region must be four numbers, [x0, y0, x1, y1]");
    auto components = numbers_of(walk, *velocity, 2,
                                 name + ": its velocity must be two numbers, [vx, vy]");
    if (!corners || !components) return std::nullopt;
    return StreamRows{walk.place_of(region->source()), number, std::move(*corners),
                      std::move(*components)};
}

std::optional<std::vector<StreamRows>> streams_of(Walk& walk, const toml::array& array) {
    std::vector<StreamRows> streams;
    std::size_t number = 0;
    for (const toml::node& node : array) {
        if (!node.is_table()) return std::nullopt;
        if (auto stream = stream_of(walk, *node.as_table(), ++number))
            streams.push_back(std::move(*stream));
    }
    return streams;
}

/// The `number`-th class, from 1; nothing after a problem.
std::optional<SpeciesRow> species_of(Walk& walk, const toml::table& table, std::size_t number) {
    static constexpr std::array<std::string_view, 4> names = {"count", "radius", "mass", "spin"};
    SpeciesRow row{walk.place_of(table.source()), number, 0, 0, 1, 0};
    const std::array<double*, 4> numbers = {&row.count, &row.radius, &row.mass, &row.spin};
    const std::size_t n_problems = walk.problems.size();
    const auto refuse = [&](const Place& place, const std::string& text) {
        add_problem(walk.problems, place, fmt::format("class {}: {}", number, text));
    };
    for (const auto& [key, node] : table) {
        const auto value = as_number(node);
        const Place place = walk.place_of(key.source());
        const auto name = std::find(names.begin(), names.end(), key.str());
        if (name == names.end())
            refuse(place, fmt::format("a class has no {}{}", quoted(key.str()),
                                      guess(key.str(), names, '\'')));
        else if (!value)
            refuse(place, fmt::format("its {} must be a number, not {}", key.str(), shown(node)));
        else
            *numbers[static_cast<std::size_t>(name - names.begin())] = *value;
    }
    if (!table.contains(names[0]) || !table.contains(names[1]))
        refuse(row.place,
               "it needs count = ... and radius = ...; mass = 1 and spin = 0 unless given");
    if (walk.problems.size() > n_problems) return std::nullopt;
    return row;
}

std::optional<std::vector<SpeciesRow>> species_list_of(Walk& walk, const toml::array& array) {
    std::vector<SpeciesRow> species;
    std::size_t number = 0;
    for (const toml::node& node : array) {
        if (!node.is_table()) return std::nullopt;
        if (auto one = species_of(walk, *node.as_table(), ++number))
            species.push_back(std::move(*one));
    }
    return species;
}

/// Whether `node` is of the kind and now stands in the settings.
bool add_value(Walk& walk, const std::string& key, ValueKind kind, const toml::node& node) {
    walk.settings.mention(key);
    Setting setting{key, walk.place_of(node.source()), {}};
    const auto number = as_number(node);
    if (kind == ValueKind::number && number) {
        setting.value = *number;
    } else if (kind == ValueKind::integer && number) {
        if (const auto* integer = node.as_integer())
            setting.value = integer->get();
        else
            setting.value = *number; // 1e5 is fine, 1.5 is refused where values are checked
    } else if (kind == ValueKind::text && node.is_string()) {
        setting.value = node.as_string()->get();
    } else if (kind == ValueKind::words && node.is_array()) {
        std::vector<std::string> words;
        for (const toml::node& element : *node.as_array()) {
            if (!element.is_string()) return false;
            words.push_back(element.as_string()->get());
        }
        setting.value = std::move(words);
    } else if (kind == ValueKind::flag && node.is_boolean()) {
        setting.value = node.as_boolean()->get();
    } else if (kind == ValueKind::rows && node.is_array()) {
        setting.value = rows_of(walk, *node.as_array(), key, 4, "four numbers, [x, y, vx, vy]");
    } else if (kind == ValueKind::fixed_discs && node.is_array()) {
        setting.value = rows_of(walk, *node.as_array(), key, 3, "three numbers, [x, y, radius]");
    } else if (kind == ValueKind::segments && node.is_array()) {
        setting.value = rows_of(walk, *node.as_array(), key, 4, "four numbers, [x0, y0, x1, y1]");
    } else if (kind == ValueKind::streams && node.is_array()) {
        auto streams = streams_of(walk, *node.as_array());
        if (!streams) return false;
        setting.value = std::move(*streams);
    } else if (kind == ValueKind::species && node.is_array()) {
        auto species = species_list_of(walk, *node.as_array());
        if (!species) return false;
        setting.value = std::move(*species);
    } else {
        return false;
    }
    walk.settings.set(std::move(setting));
    return true;
}

void walk_table(Walk& walk, const toml::table& table, const std::string& prefix) {
    for (const auto& [name, node] : table) {
        const std::string key = prefix + std::string(name.str());
        const auto kind = kind_of_key(key);
        const bool is_scene_table = is_table(key);
        if (kind) {
            if (!add_value(walk, key, *kind, node))
                add_problem(
                    walk.problems, walk.place_of(node.source()),
                    fmt::format("'{}' must be {}, not {}", key, kind_name(*kind), shown(node)));
        } else if (is_scene_table && node.is_table()) {
            walk.settings.mention(key);
            walk_table(walk, *node.as_table(), key + '.');
        } else if (is_scene_table) {
            add_problem(walk.problems, walk.place_of(name.source()),
                        fmt::format("'{}' must be a table, [{}]", key, key));
        } else {
            add_problem(walk.problems, walk.place_of(name.source()), unknown_key_text(key));
        }
    }
}

} // namespace

bool add_toml(Settings& settings, Problems& problems, std::string_view text,
              const std::string& name) {
    Walk walk{settings, problems, {name, 0}, true};
    try {
        const toml::table table = toml::parse(text);
        walk_table(walk, table, "");
        return true;
    } catch (const toml::parse_error& error) {
        add_problem(problems, walk.place_of(error.source()),
                    "not valid TOML: " + std::string(error.description()));
        return false;
    }
}

void add_toml_value(Settings& settings, Problems& problems, const std::string& key,
                    const std::string& value, const Place& place) {
    const ValueKind kind = *kind_of_key(key);
    if (kind == ValueKind::text && (value.empty() || (value[0] != '"' && value[0] != '\''))) {
        settings.set({key, place, value});
        return;
    }
    Walk walk{settings, problems, place, false};
    settings.mention(key);
    bool is_valid = value.find('\n') == std::string::npos;
    if (is_valid) {
        try {
            const toml::table table = toml::parse("value = " + value);
            is_valid = add_value(walk, key, kind, *table.get("value"));
        } catch (const toml::parse_error&) {
            is_valid = false;
        }
    }
    if (!is_valid)
        add_problem(problems, place,
                    fmt::format("must be {}, not {}", kind_name(kind), quoted(value)));
}

} // namespace carrom

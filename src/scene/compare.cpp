// SPDX-License-Identifier: BSD-3-Clause
#include "scene/compare.hpp"

#include <fmt/format.h>

#include "scene/disc_columns.hpp"
#include "scene/places.hpp"
#include "scene/toml_text.hpp"

namespace carrom {

namespace {

std::string shown(const Key& key, const SceneParameters& scene) {
    Value value = key.has_meaning(scene) ? key.get(scene) : Value{};
    if (scene.origin.is_on()) move_places(key, value, -scene.origin.x, -scene.origin.y);
    return value.is_nothing() ? "not set" : toml_text(key, value);
}

/// Describes the difference in a key; empty if both scenes agree or the key is not compared.
std::string difference_in(const Key& key, const SceneParameters& there,
                          const SceneParameters& here) {
    const bool is_there = key.has_meaning(there), is_here = key.has_meaning(here);
    const bool is_about_generator = key.need && key.need->is_of_generator;
    if (!key.is_physical || key.is_same(there, here) || (!is_there && !is_here)) return {};
    // If the generators differ, this is reported, and not the keys that only one of them has
    if (is_there != is_here && is_about_generator) return {};
    if (key.has_rows()) return fmt::format("'{}' is another list there", key.name);
    return fmt::format("'{}' is {} there and {} here", key.name, shown(key, there),
                       shown(key, here));
}

} // namespace

std::vector<std::string> physical_differences(const SceneParameters& there,
                                              const SceneParameters& here) {
    std::vector<std::string> differences;
    for (const Key& key : keys())
        if (std::string text = difference_in(key, there, here); !text.empty())
            differences.push_back(std::move(text));
    for (const SideColumn column : all_side_columns) {
        // Columns of files are not compared, because checkpoints do not store them
        const DiscColumn of_files = disc_column_of(column);
        if (!has_column(there, of_files) && !has_column(here, of_files) &&
            there.first_numbers[column] != here.first_numbers[column])
            differences.push_back(
                fmt::format("discs begin with other {}s there", info_of(column).name));
    }
    return differences;
}

} // namespace carrom

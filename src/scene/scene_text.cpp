// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_text.hpp"

#include <fmt/format.h>

#include "scene/places.hpp"
#include "scene/toml_text.hpp"

namespace carrom {

namespace {

/// A scene that has the same tables as `scene`, but all keys at their defaults.
SceneParameters with_defaults(const SceneParameters& scene) {
    SceneParameters plain;
    for (const Table& table : tables())
        if (table.is_in(scene)) table.create(plain);
    if (plain.trajectory) choose_fields(*plain.trajectory, scene);
    return plain;
}

} // namespace

std::string scene_text(const SceneParameters& scene) {
    const SceneParameters plain = with_defaults(scene);
    std::string text;
    for (const Table& table : tables()) {
        if (!table.is_in(scene)) continue;
        std::string lines;
        for (const Key& key : keys()) {
            if (key.table() != table.name) continue;
            if (!key.is_required && key.is_same(scene, plain)) continue;
            Value value = key.has_meaning(scene) ? key.get(scene) : Value{};
            if (scene.origin.is_on()) move_places(key, value, -scene.origin.x, -scene.origin.y);
            if (!value.is_nothing())
                lines += fmt::format("{} = {}\n", key.name.substr(table.name.size() + 1),
                                     toml_text(key, value));
        }
        // An optional table is written even if it has no lines, so that the reader creates it.
        if (!lines.empty() || table.is_optional())
            text += fmt::format("[{}]\n{}", table.name, lines);
    }
    return text;
}

} // namespace carrom

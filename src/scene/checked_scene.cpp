// SPDX-License-Identifier: BSD-3-Clause
#include "scene/checked_scene.hpp"

#include "scene/boundaries/boundary.hpp"
#include "scene/check.hpp"
#include "scene/checked_value.hpp"
#include "scene/limits.hpp"
#include "scene/quantity.hpp"

namespace carrom {

namespace {

/// Puts valid values into the scene as they are; of lists the valid rows.
void take_values(const Check& check) {
    for (const Table& table : tables()) {
        const auto& all = check.settings.all();
        if (std::any_of(all.begin(), all.end(), [&table](const Setting& one) {
                const Key* key = find_key(one.key); // 'discs.radius' is a key and a table
                return key ? key->table() == table.name : one.key == table.name;
            }))
            table.create(check.scene);
    }
    for (Setting& setting : check.settings.all()) {
        const Key* key = find_key(setting.key);
        if (!key || setting.is_wrong) continue;
        check_value(*key, setting, check.problems);
        const bool has_rows = key->has_rows() && std::holds_alternative<Values>(setting.value.data);
        if (!setting.is_wrong || has_rows) key->set(check.scene, setting.value);
    }
}

/// Defaults that depend on other keys.
void derive_defaults(const Check& check) {
    Scene& scene = check.scene;
    const Settings& settings = check.settings;
    if (!settings.has("discs.generator") &&
        (settings.has("discs.file") || settings.has("discs.list") || settings.has("discs.from")))
        scene.generator = Generator::file;
    if (check.columns && !check.columns->species.empty())
        scene.effects.species = check.columns->species;
    for (const SideColumn column : all_side_columns)
        if (check.columns && !check.columns->numbers[column].empty())
            scene.first_numbers[column] = check.columns->numbers[column];
    if (scene.trajectory && !settings.has("output.trajectory.fields"))
        choose_fields(*scene.trajectory, scene);
}

/// All outputs of a run have their places in one folder. A run with a folder stores checkpoints.
void place_outputs(const Check& check) {
    Scene& scene = check.scene;
    if (scene.folder.empty()) return;
    if (!scene.checkpoint) scene.checkpoint.emplace();
    scene.checkpoint->folder = scene.folder + "/checkpoints";
    if (scene.trajectory) scene.trajectory->file = scene.folder + "/trajectory.h5";
    if (scene.collisions) scene.collisions->file = scene.folder + "/collisions.h5";
    if (scene.measurements) scene.measurements->folder = scene.folder + "/measurements";
}

/// True if the text names a key whose value is wrong, so that nothing follows from it.
bool depends_on_wrong_value(const Check& check, std::string_view text) {
    const auto& all = check.settings.all();
    return std::any_of(all.begin(), all.end(), [text](const Setting& one) {
        return one.is_wrong && text.find(one.key) != std::string_view::npos;
    });
}

/// A key without a meaning, a missing key, and two keys that exclude each other are problems.
void check_needs(const Check& check, const Key& key) {
    const Settings& settings = check.settings;
    const auto is_there = [&settings](std::string_view other) { return settings.has(other); };
    const bool is_known = !key.need || !depends_on_wrong_value(check, key.need->text);
    const bool has_meaning = key.has_meaning(check.scene);
    const bool has_value = settings.is_right(key.name) || (is_there(key.name) && key.has_rows());
    if (has_value && is_known && !has_meaning)
        check.refuse({key.name}, fmt::format("'{}' has no meaning {}", key.name, key.need->text));
    const bool is_required = key.is_required && is_known && has_meaning &&
                             find_table(key.table())->is_in(check.scene);
    if (is_required && !is_there(key.name) &&
        std::none_of(key.or_from.begin(), key.or_from.end(), is_there))
        check.refuse({}, fmt::format("'{}' is missing: {}", key.name, key.help));
    for (const std::string_view other : key.instead_of)
        if (is_there(key.name) && is_there(other))
            check.refuse({other}, fmt::format("'{}' and '{}' exclude each other", other, key.name));
}

void check_rules(const Check& check) {
    for (const Rule& rule : rules()) {
        if (!rule.is_broken(check.scene)) continue;
        if (depends_on_wrong_value(check, rule.one) || depends_on_wrong_value(check, rule.other))
            continue;
        std::vector<std::string> sides;
        for (std::size_t side = 0; side < boundary_names.size(); ++side)
            if (rule.boundary == check.scene.effects.boundaries[side].kind)
                sides.push_back(fmt::format("box.{}.kind", boundary_names[side]));
        std::vector<std::string_view> names = rule.keys;
        names.insert(names.end(), sides.begin(), sides.end());
        check.refuse_first(names, fmt::format("cannot have {} together with {}: {}", rule.one,
                                              rule.other, rule.why));
    }
}

} // namespace

void fill_scene(Scene& scene, Settings& settings, Problems& problems, const DiscColumns* columns) {
    const Check check{scene, settings, problems, columns};
    take_values(check);
    derive_defaults(check);
    place_outputs(check);
    for (const Key& key : keys()) check_needs(check, key);
    check_times(check);
    for (const BoundaryDeclaration& kind : all_boundaries())
        if (kind.check_times) kind.check_times(check);
    for (const EffectDeclaration& effect : all_effects())
        if (effect.check_times) effect.check_times(check);
    if (check_discs(check)) {
        for (const BoundaryDeclaration& kind : all_boundaries())
            if (kind.check_room) kind.check_room(check);
        check_quantities(check);
        check_rows(check);
        for (const EffectDeclaration& effect : all_effects())
            if (effect.check_room) effect.check_room(check);
    }
    check_rules(check);
}

} // namespace carrom

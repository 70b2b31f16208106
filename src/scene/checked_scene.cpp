// SPDX-License-Identifier: BSD-3-Clause
#include "scene/checked_scene.hpp"

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "scene/boundaries/boundary.hpp"
#include "scene/checked_value.hpp"
#include "scene/disc_groups.hpp"
#include "scene/frozen_discs.hpp"
#include "scene/limits.hpp"
#include "scene/places.hpp"
#include "scene/quantity.hpp"
#include "scene/scene_draft.hpp"
#include "scene/species_rows.hpp"

namespace carrom {

namespace {

/// Converts positions from users' coordinates to internal ones (places.hpp). Box and origin are
/// stored first, so the result does not depend on the order of keys in the input.
void take_origin(const SceneDraft& draft, std::span<const std::pair<const Key*, Setting*>> right) {
    if (!draft.settings.has("box.origin")) return;
    for (const auto& [key, setting] : right)
        if (key->name == "box.origin" || key->name == "box.size")
            key->set(draft.scene, setting->value);
    find_origin(draft.scene);
    const Origin& origin = draft.scene.origin;
    for (const auto& [key, setting] : right)
        if (origin.is_on() && has_places(*key))
            move_places(*key, setting->value, origin.x, origin.y);
}

/// Checks that the origin is near the box, because otherwise coordinates lose precision. Texts in
/// the legacy format have no origin.
void check_origin(const SceneDraft& draft) {
    constexpr double farthest = 1000;
    const SceneParameters& scene = draft.scene;
    const double most = farthest * scene.box.longest();
    if (scene.lines_before_discs > 0 && draft.settings.has("box.origin"))
        return draft.refuse({"box.origin"}, "'box.origin' has no meaning for legacy text, whose "
                                            "places count from the lower left corner");
    if (most > 0 && !(std::fabs(scene.origin.x) <= most && std::fabs(scene.origin.y) <= most))
        draft.refuse({"box.origin"},
                     fmt::format("'box.origin' must be within {:g}, {:g} edges of the box, because "
                                 "places farther away would lose digits",
                                 most, farthest));
}

/// Stores valid values in the scene. An array with invalid rows is stored without them.
void take_values(const SceneDraft& draft) {
    for (const Table& table : tables()) {
        const auto& all = draft.settings.all();
        if (std::any_of(all.begin(), all.end(), [&table](const Setting& one) {
                // 'discs.radius' counts as a key of [discs], although a table has this name, too
                const Key* key = find_key(one.key);
                return key ? key->table() == table.name : one.key == table.name;
            }))
            table.create(draft.scene);
    }
    std::vector<std::pair<const Key*, Setting*>> right;
    for (Setting& setting : draft.settings.all()) {
        const Key* key = find_key(setting.key);
        if (!key || setting.is_wrong) continue;
        check_value(*key, setting, draft.problems);
        const bool has_rows = key->has_rows() && std::holds_alternative<Values>(setting.value.data);
        if (!setting.is_wrong || has_rows) right.emplace_back(key, &setting);
    }
    take_origin(draft, right);
    for (const auto& [key, setting] : right) key->set(draft.scene, setting->value);
    find_origin(draft.scene);
}

/// Sets members that depend on which keys the input has, or on the columns of its file of discs.
void derive_defaults(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    const Settings& settings = draft.settings;
    if (!settings.has("discs.generator") &&
        (settings.has("discs.file") || settings.has("discs.list") || settings.has("discs.from")))
        scene.generator = Generator::file;
    scene.draws_velocities = scene.generator == Generator::file &&
                             (settings.has("discs.speed") || settings.has("discs.temperature"));
    if (draft.columns && !draft.columns->species.empty())
        scene.effects.species = draft.columns->species;
    for (const SideColumn column : all_side_columns)
        if (draft.columns && !draft.columns->numbers[column].empty())
            scene.first_numbers[column] = draft.columns->numbers[column];
    if (scene.trajectory && !settings.has("output.trajectory.fields"))
        choose_fields(*scene.trajectory, scene);
}

/// Sets the paths of all outputs in the run's folder. A run with a folder writes checkpoints.
void place_outputs(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (scene.folder.empty()) return;
    if (!scene.checkpoint) scene.checkpoint.emplace();
    scene.checkpoint->folder = scene.folder + "/checkpoints";
    if (scene.trajectory) scene.trajectory->file = scene.folder + "/trajectory.h5";
    if (scene.collisions) scene.collisions->file = scene.folder + "/collisions.h5";
    if (scene.measurements) scene.measurements->folder = scene.folder + "/measurements";
}

/// Whether the text names a key whose value is wrong. Then the problem that the text describes may
/// only be a consequence of this value.
bool depends_on_wrong_value(const SceneDraft& draft, std::string_view text) {
    const auto& all = draft.settings.all();
    return std::any_of(all.begin(), all.end(), [text](const Setting& one) {
        return one.is_wrong && text.find(one.key) != std::string_view::npos;
    });
}

bool is_wrong(const SceneDraft& draft, std::string_view key) {
    return draft.settings.has(key) && draft.settings.find(key)->is_wrong;
}

/// Whether the key's meaning may depend on another key of its table that has a wrong value: in
/// tables with a key `kind`, such as [box.left], the kind decides which keys have a meaning.
bool has_wrong_neighbour(const SceneDraft& draft, const Key& key) {
    if (!find_key(std::string(key.table()) + ".kind")) return false;
    const auto& all = draft.settings.all();
    return std::any_of(all.begin(), all.end(), [&key](const Setting& one) {
        const Key* other = find_key(one.key);
        return one.is_wrong && other && other->table() == key.table();
    });
}

/// Reports if `key` has no meaning, if it is missing, or if it excludes another key of the input.
void check_needs(const SceneDraft& draft, const Key& key) {
    const Settings& settings = draft.settings;
    const auto is_there = [&settings](std::string_view other) { return settings.has(other); };
    const bool is_known = !key.need || (!depends_on_wrong_value(draft, key.need->text) &&
                                        !has_wrong_neighbour(draft, key));
    const bool has_meaning = key.has_meaning(draft.scene);
    const bool has_value = settings.is_right(key.name) || (is_there(key.name) && key.has_rows());
    if (has_value && is_known && !has_meaning)
        draft.refuse({key.name}, fmt::format("'{}' has no meaning {}", key.name, key.need->text));
    const bool is_required = key.is_required && is_known && has_meaning &&
                             find_table(key.table())->is_in(draft.scene);
    if (is_required && !is_there(key.name) &&
        std::none_of(key.or_from.begin(), key.or_from.end(), is_there))
        draft.refuse({}, fmt::format("'{}' is missing: {}", key.name, key.help));
    for (const std::string_view other : key.instead_of)
        if (is_there(key.name) && is_there(other))
            draft.refuse({other}, fmt::format("'{}' and '{}' exclude each other", other, key.name));
}

void check_rules(const SceneDraft& draft) {
    for (const Rule& rule : rules()) {
        if (!rule.is_broken(draft.scene)) continue;
        if (depends_on_wrong_value(draft, rule.one) || depends_on_wrong_value(draft, rule.other))
            continue;
        if (std::any_of(rule.keys.begin(), rule.keys.end(),
                        [&draft](std::string_view key) { return is_wrong(draft, key); }))
            continue;
        std::vector<std::string> sides;
        for (std::size_t side = 0; side < boundary_names.size(); ++side)
            if (rule.boundary == draft.scene.effects.boundaries[side].kind)
                sides.push_back(fmt::format("box.{}.kind", boundary_names[side]));
        std::vector<std::string_view> names = rule.keys;
        names.insert(names.end(), sides.begin(), sides.end());
        draft.refuse_first(names, fmt::format("cannot have {} together with {}: {}", rule.one,
                                              rule.other, rule.why));
    }
}

} // namespace

void fill_scene(SceneParameters& scene, Settings& settings, Problems& problems,
                const DiscColumns* columns) {
    const SceneDraft draft{scene, settings, problems, columns};
    take_values(draft);
    check_origin(draft);
    fill_groups(draft);
    fill_species_counts(draft);
    derive_defaults(draft);
    place_outputs(draft);
    for (const EffectDeclaration& effect : all_effects())
        if (effect.derive) effect.derive(draft);
    for (const Key& key : keys()) check_needs(draft, key);
    check_times(draft);
    for (const BoundaryDeclaration& kind : all_boundaries())
        if (kind.check_times) kind.check_times(draft);
    for (const EffectDeclaration& effect : all_effects())
        if (effect.check_times) effect.check_times(draft);
    if (check_discs(draft)) {
        for (const BoundaryDeclaration& kind : all_boundaries())
            if (kind.check_room) kind.check_room(draft);
        check_quantities(draft);
        check_stop(draft);
        for (const EffectDeclaration& effect : all_effects())
            if (effect.check_room) effect.check_room(draft);
    }
    check_rules(draft);
    take_frozen(draft);
    check_gpu(draft);
}

} // namespace carrom

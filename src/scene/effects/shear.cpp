// SPDX-License-Identifier: BSD-3-Clause
// Uniform shear between sheared sides (dynamics/space.hpp).
#include <cmath>

#include <fmt/format.h>

#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

const Need sheared{"without box.bottom.kind = \"sheared\" and box.top.kind = \"sheared\"",
                   [](const SceneParameters& s) { return s.effects.are_sheared(); }};

std::vector<Key> keys_of_shear() {
    return {
        key("effects.shear.rate", "1/step",
            "Between sheared sides: discs flow along x with rate (y - Ly / 2) in the mean.",
            [](auto& s) -> auto& { return s.effects.shear; })
            .within({-1e6, 1e6})
            .needs(sheared)
            .required(),
    };
}

std::vector<Rule> rules_of_shear() {
    return {
        rule("a sheared side", "another kind of side opposite",
             "box.bottom.kind and box.top.kind must both be \"sheared\", or neither",
             {"box.bottom.kind", "box.top.kind"},
             [](const SceneParameters& s) {
                 const auto& sides = s.effects.boundaries;
                 return (sides[2].kind == BoundaryKind::sheared) !=
                        (sides[3].kind == BoundaryKind::sheared);
             }),
        rule("sheared sides left or right", "a flow along x",
             "the flow is along x and grows with y; make bottom and top sheared",
             {"box.left.kind", "box.right.kind"},
             [](const SceneParameters& s) {
                 const auto& sides = s.effects.boundaries;
                 return sides[0].kind == BoundaryKind::sheared ||
                        sides[1].kind == BoundaryKind::sheared;
             }),
        rule("sheared sides", "walls or open sides left and right",
             "the flow goes through them; make box.left.kind and box.right.kind \"periodic\"",
             {"box.left.kind", "box.right.kind"},
             [](const SceneParameters& s) {
                 return s.effects.are_sheared() && !s.effects.is_periodic_x();
             }),
        rule("sheared sides", "drag or obstacles",
             "both stand still, and the flow has no place where it does",
             {"effects.drag.rate", "effects.obstacles.discs", "effects.obstacles.segments",
              "effects.obstacles.arcs", "effects.obstacles.polygons", "box.shape"},
             [](const SceneParameters& s) {
                 return s.effects.are_sheared() && (s.effects.drag != 0 || has_fixed_bodies(s));
             }),
        rule("sheared sides", "\"image\"", "images move: whole numbers do not say where they are",
             {"output.trajectory.fields"},
             [](const SceneParameters& s) {
                 return s.trajectory && s.trajectory->has_image && s.effects.are_sheared();
             }),
    };
}

/// Warns that a sheared gas does not stay at `discs.temperature`: a thermostat, or shear and lost
/// energy, determine the temperature later.
void warn_of_temperature(const SceneDraft& draft) {
    SceneParameters& scene = draft.scene;
    if (!scene.effects.are_sheared() || !draft.settings.has("discs.temperature")) return;
    const Thermostat& thermostat = scene.effects.thermostat;
    if (thermostat.has_temperature() && thermostat.temperature == scene.temperature) return;
    const char* then =
        thermostat.has_temperature() ? "the thermostat keeps its own afterwards"
        : are_pairs_lossy(scene.effects)
            ? "the flow comes to the temperature at which collisions lose what it gives, and the "
              "report has it; effects.thermostat.kind = \"rescale\" keeps one"
            : "the flow heats discs that lose no energy for ever; effects.thermostat.kind = "
              "\"rescale\" keeps a temperature";
    scene.warnings.push_back(
        fmt::format("discs.temperature is that of the start only, because {}", then));
}

} // namespace

namespace effects {

EffectDeclaration shear() {
    return {.tables = {{"effects.shear", "A flow between sheared sides, whose images move."}},
            .keys = keys_of_shear(),
            .rules = rules_of_shear(),
            .check_room = warn_of_temperature,
            .summary =
                [](const Effects& e) {
                    return e.are_sheared() ? fmt::format("shear at the rate {:g}", e.shear) : "";
                },
            .usual_speed =
                [](const SceneParameters& s) { return std::fabs(s.effects.shear) * s.box.y; }};
}

} // namespace effects

} // namespace carrom

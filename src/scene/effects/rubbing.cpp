// SPDX-License-Identifier: BSD-3-Clause
// Walls and obstacles with friction, and surfaces that slide (dynamics/rubbing.hpp).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "dynamics/surface_table.hpp"
#include "scene/boundaries/boundary.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

bool slides(const Effects& effects, std::size_t side) {
    return effects.boundaries[side].kind == BoundaryKind::thermal || does_rub(effects, side);
}

template <class SurfaceOf>
void add_surface(std::vector<Key>& all, const std::string& table, const SurfaceOf& surface_of,
                 const Need& body, const Need& rubbing, const Need& sliding,
                 const char* help_of_velocity) {
    all.push_back(
        key(table + ".tangential_restitution", "1",
            "Share of the sliding velocity that is reversed where surfaces stick; -1 is smooth.",
            [surface_of](auto& s) -> auto& { return surface_of(s).tangential_restitution; })
            .within({-1, 1})
            .needs(body));
    all.push_back(key(table + ".friction", "1",
                      "Coulomb's coefficient; discs slide on it beyond that.",
                      [surface_of](auto& s) -> auto& { return surface_of(s).friction; })
                      .by_default("no limit")
                      .within({0, 1e6})
                      .needs(rubbing));
    all.push_back(key(table + ".velocity", "length/step", help_of_velocity,
                      [surface_of](auto& s) -> auto& { return surface_of(s).velocity; })
                      .within({-1e6, 1e6})
                      .needs(sliding));
}

std::vector<Key> keys_of_rubbing() {
    std::vector<Key> all;
    for (std::size_t side = 0; side < boundary_names.size(); ++side) {
        const std::string table = std::string("box.") + boundary_names[side];
        add_surface(
            all, table, [side](auto& s) -> auto& { return s.effects.boundaries[side].surface; },
            side_reflects(side),
            {"without " + table + ".tangential_restitution above -1",
             [side](const SceneParameters& s) {
                 return s.effects.boundaries[side].surface.tangential_restitution != -1;
             }},
            {"without " + table + ".kind = \"thermal\" or a tangential_restitution above -1",
             [side](const SceneParameters& s) { return slides(s.effects, side); }},
            side < 2 ? "Velocity of the surface along +y; the side stays where it is."
                     : "Velocity of the surface along +x; the side stays where it is.");
    }
    add_surface(
        all, "effects.obstacles", [](auto& s) -> auto& { return s.effects.fixed_bodies.surface; },
        {no_obstacles, has_fixed_bodies},
        {"without effects.obstacles.tangential_restitution above -1",
         [](const SceneParameters& s) {
             return s.effects.fixed_bodies.surface.tangential_restitution != -1;
         }},
        {"without effects.obstacles.tangential_restitution above -1",
         [](const SceneParameters& s) {
             return does_rub(s.effects, SurfaceContacts::fixed_bodies);
         }},
        "Velocity of the surface, counterclockwise around the body, which stays where it is. Arcs "
        "and the wall of a 'box.shape' turn around their centre.");
    return all;
}

/// Checks that no surface slides faster than discs may fly.
void check_room_of_rubbing(const SceneDraft& draft) {
    const Effects& effects = draft.scene.effects;
    const auto hold = [&draft](const std::string& table, const Surface& surface) {
        const std::string key = table + ".velocity",
                          text = speed_problem(surface.velocity, draft.scene);
        if (!text.empty()) draft.refuse({key}, fmt::format("'{}': {}", key, text));
    };
    for (std::size_t side = 0; side < boundary_names.size(); ++side)
        hold(std::string("box.") + boundary_names[side], effects.boundaries[side].surface);
    hold("effects.obstacles", effects.fixed_bodies.surface);
}

std::string text_of(const Surface& surface) {
    std::string text;
    if (surface.rubs()) {
        text = fmt::format("rubs with {:g}", surface.tangential_restitution);
        if (std::isfinite(surface.friction))
            text += fmt::format(", friction {:g}", surface.friction);
    }
    if (surface.velocity != 0)
        text += fmt::format("{}slides at {:g}", text.empty() ? "" : " and ", surface.velocity);
    return text;
}

std::string summary_of_rubbing(const Effects& effects) {
    std::string all;
    const auto add = [&all](const std::string& what, const std::string& does) {
        if (!does.empty()) all += (all.empty() ? "" : "; ") + what + ' ' + does;
    };
    for (std::size_t side = 0; side < boundary_names.size(); ++side)
        add(fmt::format("{} wall", boundary_names[side]),
            text_of(effects.boundaries[side].surface));
    if (effects.fixed_bodies.are_any()) add("obstacle", text_of(effects.fixed_bodies.surface));
    return all;
}

CheckAllowance allowance_of_rubbing(const Effects& effects) {
    CheckAllowance allowance;
    const auto add = [&](const Surface& surface) {
        const bool is_elastic = surface.tangential_restitution == 1 && std::isinf(surface.friction);
        allowance.collisions_take_energy |= surface.rubs() && !is_elastic;
        allowance.walls_give_energy |= surface.velocity != 0;
    };
    for (const Boundary& side : effects.boundaries) add(side.surface);
    if (effects.fixed_bodies.are_any()) add(effects.fixed_bodies.surface);
    return allowance;
}

/// Along a periodic axis, only sides parallel to it and obstacles can change the common motion.
CommonMotion common_motion_by_surfaces(const Effects& effects, Axis axis) {
    const std::size_t low = axis == Axis::x ? 2 : 0;
    CommonMotion motion;
    for (std::size_t side = low; side < low + 2; ++side) {
        const bool acts = slides(effects, side);
        motion.is_stopped |= acts;
        motion.is_driven |= acts && effects.boundaries[side].surface.velocity != 0;
    }
    motion.is_driven |= effects.fixed_bodies.are_any() &&
                        effects.fixed_bodies.surface.velocity != 0;
    return motion;
}

double usual_speed_of_surfaces(const SceneParameters& scene) {
    double speed = std::fabs(scene.effects.fixed_bodies.surface.velocity);
    for (const Boundary& side : scene.effects.boundaries)
        speed = std::max(speed, std::fabs(side.surface.velocity));
    return speed;
}

} // namespace

namespace effects {

EffectDeclaration rubbing() {
    return {.keys = keys_of_rubbing(),
            .check_room = check_room_of_rubbing,
            .summary = summary_of_rubbing,
            .allowance = allowance_of_rubbing,
            .usual_speed = usual_speed_of_surfaces,
            .common_motion = common_motion_by_surfaces};
}

} // namespace effects

} // namespace carrom

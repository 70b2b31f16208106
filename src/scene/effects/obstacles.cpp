// SPDX-License-Identifier: BSD-3-Clause
// Bodies that stand fixed in the box (dynamics/obstacles.hpp).
#include <cmath>

#include <fmt/format.h>

#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

/// The largest sum of a fixed disc's radius and that of a disc, over the box, so that
/// a disc touches only the nearest images of a body.
constexpr double largest_in_period = 0.99;

const Need some_obstacles{"without 'effects.obstacles.discs' or 'effects.obstacles.segments'",
                          [](const SceneParameters& s) { return has_obstacles(s); }};

std::vector<Key> keys_of_obstacles() {
    return {
        key("effects.obstacles.discs", "length", "Fixed discs; a radius of 0 is a point.",
            [](auto& s) -> auto& { return s.effects.obstacles.discs; })
            .with_rows({{"", "[x, y, radius]", 3, 3}}),
        key("effects.obstacles.segments", "length",
            "Straight walls without thickness; discs meet both faces and both ends.",
            [](auto& s) -> auto& { return s.effects.obstacles.segments; })
            .with_rows({{"", "[x0, y0, x1, y1]", 4, 4}}),
        key("effects.obstacles.restitution", "1",
            "Share of the normal velocity that is left, of all obstacles.",
            [](auto& s) -> auto& { return s.effects.obstacles.restitution; })
            .within(Range{0, 1})
            .needs(some_obstacles),
    };
}

std::vector<Rule> rules_of_obstacles() {
    return {
        rule("obstacles", "drag and gravity at once",
             "contacts with bodies are found on straight lines and parabolas",
             {"effects.drag.rate"},
             [](const SceneParameters& s) {
                 return has_obstacles(s) && s.effects.drag > 0 && s.effects.gravity.is_any();
             }),
        rule("obstacles", "walls that move",
             "obstacles need walls at rest: a disc between the two would have no way out",
             {"effects.obstacles.discs", "effects.obstacles.segments"},
             [](const SceneParameters& s) {
                 return has_obstacles(s) && !are_walls_at_rest(s.effects);
             }),
        rule("obstacles",
             "discs.generator = \"lattice\", \"triangular\", \"compressed\" or \"legacy\"",
             "these generators know nothing of obstacles; insert discs at random (at a packing "
             "fraction that allows it), list them, or freeze some of them (discs.freeze)",
             {"discs.generator", "discs.packing", "discs.radius", "discs.species"},
             [](const SceneParameters& s) {
                 return s.effects.obstacles.are_any() &&
                        (s.generator == Generator::lattice ||
                         s.generator == Generator::triangular ||
                         s.generator == Generator::compressed || s.generator == Generator::legacy);
             }),
    };
}

void check_obstacles(const SceneDraft& draft) {
    const Box box = draft.scene.box;
    const double size = box.longest(), radius = draft.scene.radius;
    const bool is_periodic = draft.scene.effects.are_periodic();
    const double period = draft.scene.effects.periods(box).shortest();
    const auto is_inside = [box](double x, double y) {
        return x >= 0 && x <= box.x && y >= 0 && y <= box.y;
    };
    draft.refuse_rows("effects.obstacles.discs", [&](const Numbers& n, std::size_t) -> std::string {
        if (!is_inside(n[0], n[1]))
            return fmt::format("the centre ({}, {}) is not in the box", n[0], n[1]);
        if (!(n[2] >= 0 && n[2] <= size))
            return fmt::format("the radius must be from 0 to {}, not {}", size, n[2]);
        if (is_periodic && !(n[2] + radius <= largest_in_period * period))
            return fmt::format("the radius must be at most {:g}, not {}: with a disc's it would "
                               "reach through a periodic box and into itself",
                               largest_in_period * period - radius, n[2]);
        return {};
    });
    draft.refuse_rows(
        "effects.obstacles.segments", [&](const Numbers& n, std::size_t) -> std::string {
            if (!is_inside(n[0], n[1]) || !is_inside(n[2], n[3]))
                return fmt::format("the segment from ({}, {}) to ({}, {}) has an end outside the "
                                   "box",
                                   n[0], n[1], n[2], n[3]);
            const double length = std::hypot(n[2] - n[0], n[3] - n[1]);
            if (!(length > 0x1p-30 * size))
                return fmt::format("a segment of length {}: a point is a fixed disc of radius 0",
                                   length);
            return {};
        });
}

std::string summary_of_obstacles(const Effects& effects) {
    const ObstacleList& all = effects.obstacles;
    if (!all.are_any()) return {};
    const auto counted = [](std::size_t n, const char* what) {
        return n == 0 ? std::string() : fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
    };
    const std::string discs = counted(all.discs.size(), "fixed disc"),
                      segments = counted(all.segments.size(), "segment");
    return discs + (discs.empty() || segments.empty() ? "" : " and ") + segments +
           (all.restitution < 1 ? fmt::format(" of restitution {:g}", all.restitution) : "");
}

} // namespace

namespace effects {

EffectDeclaration obstacles() {
    return {
        .tables = {{"effects.obstacles", "Bodies that stand fixed in the box."}},
        .keys = keys_of_obstacles(),
        .rules = rules_of_obstacles(),
        .check_room = check_obstacles,
        .summary = summary_of_obstacles,
        .allowance =
            [](const Effects& e) {
                return CheckAllowance{.collisions_take_energy = e.obstacles.restitution < 1};
            },
        .lets_discs_rest = [](const Effects& e) { return e.obstacles.restitution < 1; },
        .common_motion = [](const Effects& e,
                            Axis) { return CommonMotion{.is_stopped = e.obstacles.are_any()}; }};
}

} // namespace effects

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// A wall that moves at a constant speed: a piston.
#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

/// The left and bottom walls may only move inwards, because the box begins at 0 and positions
/// outside of it are invalid.
Range wall_speeds(std::size_t side) {
    if (side % 2 == 1) return {};
    return {.low = 0, .why = "the wall would leave the box; let the opposite one move out"};
}

std::vector<Key> keys_of_moving_side(std::size_t side) {
    return {key(side_key(side, "speed"), "length/step", "Speed of a moving wall along +x or +y.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].speed; })
                .within(wall_speeds(side))
                .needs(side_needs(side, BoundaryKind::moving))
                .required()};
}

std::vector<Rule> rules_of_moving_sides() {
    return {
        rule("a moving wall", "time.method = \"time-stepped\"",
             "walls are at rest there; take time.method = \"event-driven\"", BoundaryKind::moving,
             [](const SceneParameters& s) { return has_moving(s) && is_time_stepped(s); }),
    };
}

/// Checks that at the last step the discs have room, and that no edge has more than doubled.
void check_moving_walls(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    const auto& sides = scene.effects.boundaries;
    const Extent end = extent_at(scene.effects, scene.box, static_cast<double>(scene.steps));
    const double width = end.x_high - end.x_low, height = end.y_high - end.y_low;
    const bool is_long = end.x_high > 2 * scene.box.x || end.y_high > 2 * scene.box.y;
    for (std::size_t side = 0; side < sides.size(); ++side) {
        if (sides[side].speed == 0) continue;
        if (!has_room(scene, width, height))
            draft.refuse({side_key(side, "speed")},
                         fmt::format("after {} steps the box would be {} by {}: too small for its "
                                     "discs",
                                     scene.steps, width, height));
        else if (is_long)
            draft.refuse({side_key(side, "speed")},
                         fmt::format("after {} steps the box would be more than twice as long as "
                                     "at the start",
                                     scene.steps));
        break;
    }
}

} // namespace

namespace boundaries {

BoundaryDeclaration moving() {
    return {.kind = BoundaryKind::moving,
            .help = "a piston",
            .has_restitution = true,
            .is_at_rest = false,
            .keys_of_side = keys_of_moving_side,
            .rules = rules_of_moving_sides(),
            .check_room = check_moving_walls,
            .summary =
                [](const Boundary& side, std::string_view name) {
                    return fmt::format("{} wall{} moving at {:g}", name, loss_text(side),
                                       side.speed);
                },
            .allowance =
                [](const Boundary& side) {
                    return CheckAllowance{.walls_give_energy = side.speed != 0};
                }};
}

} // namespace boundaries

} // namespace carrom

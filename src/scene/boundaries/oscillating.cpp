// SPDX-License-Identifier: BSD-3-Clause
// A wall that oscillates about its line: a shaker (dynamics/oscillation.hpp). The self-check
// computes the largest work of such a wall from its speed, so the wall declares no allowance.
#include <algorithm>

#include "dynamics/oscillation.hpp"
#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

/// The shortest period, in units of the time between syncs. Phases at syncs are rounded to 2^-53 of
/// the time since the start, so they would be inaccurate for shorter periods.
constexpr double smallest_period = 1e-6;

bool has_oscillating(const SceneParameters& s) {
    return has_boundary(s.effects, BoundaryKind::oscillating);
}

std::vector<Key> keys_of_oscillating_side(std::size_t side) {
    const Need oscillating = side_needs(side, BoundaryKind::oscillating);
    return {key(side_key(side, "amplitude"), "length",
                "A: the wall is A sin(2 pi t / period + phase) from its line, along +x or +y.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].amplitude; })
                .within({.low = 0})
                .needs(oscillating)
                .required(),
            key(side_key(side, "period"), "steps", "Period of an oscillating wall.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].period; })
                .within({.low = 0, .excludes_low = true})
                .needs(oscillating)
                .required(),
            key(side_key(side, "phase"), "radians", "Phase of an oscillating wall at step 0.",
                [side](auto& s) -> auto& { return s.effects.boundaries[side].phase; })
                .within({-100, 100})
                .needs(oscillating)};
}

std::vector<Rule> rules_of_oscillating_sides() {
    return {
        rule("an oscillating wall", "time.method = \"time-stepped\"",
             "walls are at rest there; take time.method = \"event-driven\"",
             BoundaryKind::oscillating,
             [](const SceneParameters& s) { return has_oscillating(s) && is_time_stepped(s); }),
        rule("an oscillating wall", "drag, or a force that changes",
             "contacts are found on straight lines and parabolas", BoundaryKind::oscillating,
             [](const SceneParameters& s) {
                 return has_oscillating(s) &&
                        (s.effects.drag != 0 || s.effects.acceleration().sways());
             }),
    };
}

/// Limits the contact time, during which the wall's acceleration must change little.
void check_contact_at_oscillating_walls(const SceneDraft& draft) {
    for (const Boundary& side : draft.scene.effects.boundaries)
        if (side.kind == BoundaryKind::oscillating)
            limit_contact_time(draft, side.period / 8, "an eighth of a wall's period");
}

/// Whether generated discs could overlap the wall, because it starts inside the box.
bool begins_before_its_line(const SceneParameters& scene, std::size_t side) {
    if (scene.generator == Generator::file) return false;
    const double place = oscillation_at(scene.effects.boundaries[side], 0).place;
    return (side % 2 == 0 ? place : -place) > 0x1p-52 * scene.box.longest();
}

void check_oscillating_wall(const SceneDraft& draft, std::size_t side) {
    const SceneParameters& scene = draft.scene;
    const Boundary& wall = scene.effects.boundaries[side];
    const double least = smallest_period * steps_between_syncs(scene);
    const std::string amplitude = side_key(side, "amplitude"), phase = side_key(side, "phase");
    if (wall.period < least)
        draft.refuse({side_key(side, "period")},
                     fmt::format("'{}' must be at least {:g} steps, a millionth of the time "
                                 "between syncs ('time.sync_every'), not {}",
                                 side_key(side, "period"), least, wall.period));
    for (const double time : {0.0, static_cast<double>(scene.steps)}) {
        const Extent room = extent_of_lines(scene.effects, scene.box, time, 1);
        const double width = room.x_high - room.x_low, height = room.y_high - room.y_low;
        if (has_room(scene, width, height)) continue;
        draft.refuse({amplitude}, fmt::format("'{}' = {} leaves a box of {} by {}: too small for "
                                              "its discs",
                                              amplitude, wall.amplitude, width, height));
        break;
    }
    if (const std::string text = speed_problem(largest_wall_speed(scene.effects), scene);
        !text.empty())
        draft.refuse({amplitude}, fmt::format("'{}': {}", amplitude, text));
    if (begins_before_its_line(scene, side))
        draft.refuse({phase, amplitude},
                     fmt::format("the {} wall begins inside the box, where generated discs may be; "
                                 "take another '{}', or list the discs",
                                 boundary_names[side], phase));
}

void check_oscillating_walls(const SceneDraft& draft) {
    for (std::size_t side = 0; side < boundary_names.size(); ++side)
        if (draft.scene.effects.boundaries[side].kind == BoundaryKind::oscillating)
            check_oscillating_wall(draft, side);
}

} // namespace

namespace boundaries {

BoundaryDeclaration oscillating() {
    return {.kind = BoundaryKind::oscillating,
            .help = "a shaker",
            .has_restitution = true,
            .is_at_rest = false,
            .lets_discs_rest = true,
            .keys_of_side = keys_of_oscillating_side,
            .rules = rules_of_oscillating_sides(),
            .check_times = check_contact_at_oscillating_walls,
            .check_room = check_oscillating_walls,
            .summary = [](const Boundary& side, std::string_view name) {
                return fmt::format("{} wall{} oscillating by {:g} in {:g}", name, loss_text(side),
                                   side.amplitude, side.period);
            }};
}

} // namespace boundaries

} // namespace carrom

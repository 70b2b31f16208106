// SPDX-License-Identifier: BSD-3-Clause
// Discs that grow (dynamics/bodies.hpp).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "dynamics/surface_table.hpp"
#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

std::vector<Key> keys_of_growth() {
    return {
        key("effects.growth.rate", "1/step",
            "Radii grow by this share of their first value in each step.",
            [](auto& s) -> auto& { return s.effects.growth; })
            .within({.low = 0}),
    };
}

std::vector<Rule> rules_of_growth() {
    return {
        rule("growing discs", "time.method = \"time-stepped\"",
             "radii stay there; take time.method = \"event-driven\"", {"effects.growth.rate"},
             [](const SceneParameters& s) { return has_growing_discs(s) && is_time_stepped(s); }),
        rule("growing discs", "rough discs, or effects.contact.kind = \"none\"",
             "growing discs need smooth discs that collide, because surfaces push each other apart",
             {"effects.growth.rate"},
             [](const SceneParameters& s) {
                 return has_growing_discs(s) &&
                        (is_rough(s) || s.effects.contact.kind == ContactKind::none);
             }),
        rule("growing discs", "gravity or another force in flight, or drag",
             "growing discs need straight flights, on which contacts are found",
             {"effects.growth.rate"},
             [](const SceneParameters& s) {
                 return has_growing_discs(s) && !s.effects.are_flights_free();
             }),
        rule(
            "growing discs", "obstacles that rub or slide",
            "growing discs need smooth surfaces, because a surface that grows pushes only outwards",
            {"effects.growth.rate"},
            [](const SceneParameters& s) {
                return has_growing_discs(s) && has_fixed_bodies(s) &&
                       does_rub(s.effects, SurfaceContacts::fixed_bodies);
            }),
        rule("growing discs", "sides that are no smooth walls at rest, and not periodic",
             "growing discs need sides that stay where they are, do not rub and let nothing out",
             {"effects.growth.rate"},
             [](const SceneParameters& s) {
                 return has_growing_discs(s) && !do_sides_take_growing_discs(s.effects);
             }),
    };
}

/// Checks that the growing discs still have room at the last step.
void check_growth(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    if (scene.effects.growth == 0) return;
    const double growth = scene.effects.size_at(static_cast<double>(scene.steps));
    const double densest = scene.effects.species.empty() ? largest_packing : 1;
    const auto room = [&scene](double side, bool is_periodic) {
        return side / ((is_periodic ? 4 * (1 + 1e-6) : 2) * scene.radius);
    };
    const double most = std::min({std::sqrt(densest / scene.packing()),
                                  room(scene.box.x, scene.effects.is_periodic_x()),
                                  room(scene.box.y, scene.effects.is_periodic_y())});
    // check_sizes and check_periodic_box report discs that have no room at the start
    if (growth <= most || most < 1) return;
    draft.refuse(
        {"effects.growth.rate"},
        fmt::format("after {} steps discs of radius {:g} would cover {:.4g} times the box; "
                    "there is room for them up to step {:.0f}",
                    scene.steps, scene.radius * growth, scene.last_packing(),
                    std::floor((most - 1) / scene.effects.growth)));
}

} // namespace

namespace effects {

EffectDeclaration growth() {
    return {
        .tables = {{"effects.growth", "Discs that grow."}},
        .keys = keys_of_growth(),
        .rules = rules_of_growth(),
        .check_room = check_growth,
        .summary =
            [](const Effects& e) {
                return e.growth != 0 ? fmt::format("radii growing by {:g} a step", e.growth) : "";
            },
        .allowance =
            [](const Effects& e) { return CheckAllowance{.surfaces_give_energy = e.growth != 0}; },
        // Surfaces of growing discs move outwards at a constant speed, and so they do work.
        .work_in_collision = [](const Effects& e, double impulse,
                                double radii) { return impulse * (e.growth * radii); },
        .usual_speed = [](const SceneParameters& s) { return s.radius * s.effects.growth; }};
}

} // namespace effects

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Uniform gravity (dynamics/gravity.hpp).
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "dynamics/drag.hpp"
#include "dynamics/gravity.hpp"
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

std::vector<Key> keys_of_gravity() {
    return {
        key("effects.gravity.x", "length/step^2", "Acceleration along x.",
            [](auto& s) -> auto& { return s.effects.gravity.x; }),
        key("effects.gravity.y", "length/step^2", "Acceleration along y.",
            [](auto& s) -> auto& { return s.effects.gravity.y; }),
    };
}

std::vector<Rule> rules_of_gravity() {
    return {
        rule("gravity", "time.method = \"time-stepped\"",
             "discs fly straight there; take time.method = \"event-driven\"",
             {"effects.gravity.y", "effects.gravity.x"},
             [](const Scene& s) { return s.effects.gravity.is_any() && is_time_stepped(s); }),
        rule("gravity along x", "periodic sides left and right",
             "discs would fall for ever, unless rough walls or drag stop them: not in this version",
             {"effects.gravity.x"},
             [](const Scene& s) { return s.effects.gravity.x != 0 && s.effects.is_periodic_x(); }),
        rule("gravity along y", "periodic sides bottom and top",
             "discs would fall for ever, unless rough walls or drag stop them: not in this version",
             {"effects.gravity.y"},
             [](const Scene& s) { return s.effects.gravity.y != 0 && s.effects.is_periodic_y(); }),
    };
}

/// The falling frame must not leave the box far behind: its coordinates would be coarser than the
/// box's.
void check_fall(const Check& check) {
    const Scene& scene = check.scene;
    const double time = steps_between_syncs(scene), drag = scene.effects.drag;
    if (drag * time > longest_drag) return; // reported already
    const double fall = drag > 0 ? dragged_fall(drag, drag_clock(drag, time)) : 0.5 * time * time;
    for (const auto& [key, g] : {std::pair("effects.gravity.x", scene.effects.gravity.x),
                                 {"effects.gravity.y", scene.effects.gravity.y}}) {
        if (std::fabs(g) * fall <= 0.5 * scene.box.longest()) continue;
        const double longest = std::floor(std::sqrt(scene.box.longest() / std::fabs(g)) *
                                          static_cast<double>(scene.micro_steps));
        check.refuse({key},
                     fmt::format("'{}' = {} makes discs fall further than half the box "
                                 "from sync to sync; {}",
                                 key, g,
                                 longest >= 1
                                     ? fmt::format("time.sync_every = {} or less will do", longest)
                                     : "take more time.micro_steps"));
    }
}

} // namespace

namespace effects {

EffectDeclaration gravity() {
    return {.tables = {{"effects.gravity", "Uniform gravity."}},
            .keys = keys_of_gravity(),
            .rules = rules_of_gravity(),
            .check_room = check_fall,
            .summary =
                [](const Effects& e) {
                    return e.gravity.is_any()
                               ? fmt::format("gravity ({:g}, {:g})", e.gravity.x, e.gravity.y)
                               : "";
                },
            .allowance =
                [](const Effects& e) {
                    return CheckAllowance{.collisions_take_energy = e.gravity.is_any() &&
                                                                    e.drag != 0};
                },
            .usual_speed =
                [](const Scene& s) {
                    const Gravity& g = s.effects.gravity;
                    return std::sqrt(2 * (std::fabs(g.x) + std::fabs(g.y)) * s.box.longest());
                }};
}

} // namespace effects

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Linear drag (dynamics/drag.hpp).
#include <cmath>

#include <fmt/format.h>

#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

namespace {

std::vector<Key> keys_of_drag() {
    return {
        key("effects.drag.rate", "1/step",
            "c of dv/dt = -c v, for all discs alike. At most 4 per time between syncs.",
            [](auto& s) -> auto& { return s.effects.drag; })
            .within({.low = 0}),
    };
}

std::vector<Rule> rules_of_drag() {
    return {
        rule("drag", "time.method = \"time-stepped\"",
             "discs keep their speed there; take time.method = \"event-driven\"",
             {"effects.drag.rate"},
             [](const SceneParameters& s) { return s.effects.drag != 0 && is_time_stepped(s); }),
        rule("drag", "rough discs", "spins would need a drag of their own", {"effects.drag.rate"},
             [](const SceneParameters& s) { return s.effects.drag != 0 && is_rough(s); }),
    };
}

/// Limits the drag rate times the time between syncs, because discs would lose nearly all their
/// velocity from one sync to the next if this product were larger.
void check_times_of_drag(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    const double interval = steps_between_syncs(scene);
    if (scene.effects.drag * interval > longest_drag)
        draft.refuse({"effects.drag.rate"},
                     fmt::format("'effects.drag.rate' = {} leaves less than a fiftieth of a "
                                 "velocity from sync to sync: {:g} at most, or a smaller "
                                 "time.sync_every",
                                 scene.effects.drag, longest_drag / interval));
}

} // namespace

namespace effects {

EffectDeclaration drag() {
    return {
        .tables = {{"effects.drag", "Air at rest that slows discs down."}},
        .keys = keys_of_drag(),
        .rules = rules_of_drag(),
        .check_times = check_times_of_drag,
        .summary =
            [](const Effects& e) { return e.drag != 0 ? fmt::format("drag {:g}", e.drag) : ""; },
        // Under a force the upper bound is 1, because the loss then depends on each disc's path.
        .energy_left =
            [](const Effects& e, double time) {
                return e.acceleration().is_on() ? 1 : std::exp(-2 * e.drag * time);
            }};
}

} // namespace effects

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The keys of [machine], and the features that a GPU can run: effects and sides that declare it,
// and measurements that do not need each collision.
#include <fmt/format.h>

#include "scene/boundaries/boundary.hpp"
#include "scene/key_members.hpp"
#include "scene/quantity.hpp"
#include "scene/rule_parts.hpp"

namespace carrom {

std::vector<Key> keys_of_machine() {
    return {key("machine.gpu", "",
                "Step the discs on a GPU of NVIDIA, with the bits of a run without one.",
                [](auto& s) -> auto& { return s.gpu; })
                .not_physical()};
}

std::vector<Rule> rules_of_machine() {
    return {
        rule("machine.gpu", "the event-driven method",
             "this version has the time-stepped method on GPUs alone", {"machine.gpu"},
             [](const SceneParameters& s) { return s.gpu && !is_time_stepped(s); }),
        rule("machine.gpu", "output.collisions", "this version lists no single collisions of a GPU",
             {"machine.gpu"},
             [](const SceneParameters& s) { return s.gpu && s.collisions.has_value(); }),
    };
}

void check_gpu(const SceneDraft& draft) {
    const SceneParameters& scene = draft.scene;
    if (!scene.gpu) return;
    const auto refuse = [&](const std::string& what) {
        draft.refuse(
            {"machine.gpu"},
            fmt::format("this version does not do {} on a GPU; try: without machine.gpu", what));
    };
    const Effects& effects = scene.effects;
    for (const EffectDeclaration& effect : all_effects()) {
        const std::string text = effect.summary ? effect.summary(effects) : "";
        if (!text.empty() && !(effect.runs_on_gpu && effect.runs_on_gpu(effects))) refuse(text);
    }
    for (const BoundaryDeclaration& kind : all_boundaries())
        for (std::size_t side = 0; side < boundary_names.size(); ++side) {
            const Boundary& boundary = effects.boundaries[side];
            if (boundary.kind != kind.kind) continue;
            if (!(kind.runs_on_gpu && kind.runs_on_gpu(boundary)))
                refuse(kind.summary(boundary, boundary_names[side]));
        }
    for (const Quantity& quantity : declared_quantities())
        if (quantity.follows_collisions && measures(scene, quantity.name))
            refuse(fmt::format("the measurement \"{}\", which follows single collisions,",
                               quantity.name));
}

} // namespace carrom

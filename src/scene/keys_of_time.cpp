// SPDX-License-Identifier: BSD-3-Clause
// The keys of [time] and [time.stop], and checks of the conditions that end a run.
#include "scene/effects/effect.hpp"
#include "scene/key_members.hpp"
#include "scene/limits.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

namespace {

const Need naive{"without time.arithmetic = \"naive\"",
                 [](const SceneParameters& s) { return s.arithmetic == Arithmetic::naive; }};

const Need open_side{"without a side of kind = \"open\"",
                     [](const SceneParameters& s) { return s.effects.have_open_boundaries(); }};

std::vector<Key> keys_of_steps() {
    return {
        key("time.steps", "steps", "S, how many steps to run; 0 shows the start.",
            [](auto& s) -> auto& { return s.steps; })
            .within({0, largest_steps})
            .required()
            .not_physical(),
        key("time.method", "",
            "Event-driven: every collision at its time. Time-stepped: at most one collision per "
            "disc and micro-step; legacy text has this one.",
            [](auto& s) -> auto& { return s.method; })
            .formerly("time.collisions"),
        key("time.micro_steps", "micro-steps/step",
            "K, the micro-steps of a step. A power of two scales velocities exactly.",
            [](auto& s) -> auto& { return s.micro_steps; })
            .within({1, largest_steps}),
        key("time.sync_every", "micro-steps",
            "Time between common rewrites of all positions. Another value rounds "
            "differently. Under strong forces, and in fields, the default is 32, 16 or less.",
            [](auto& s) -> auto& { return s.sync_every; })
            .within({1, 0x1p30}),
        key("time.accuracy", "1",
            "A pilot chooses the fastest method with at most this relative error.",
            [](auto& s) -> auto& { return s.accuracy; })
            .by_default("none")
            .within({.low = 0, .excludes_low = true})
            .excludes({"time.method", "time.micro_steps", "time.precision", "time.arithmetic",
                       "time.contraction"}),
        key("time.precision", "", "The precision in which states are computed and stored.",
            [](auto& s) -> auto& { return s.precision; }),
        key("time.arithmetic", "",
            "Naive: contacts by the course program's formula, which loses digits.",
            [](auto& s) -> auto& { return s.arithmetic; }),
        key("time.contraction", "", "Fuse the naive formula's products with their sums.",
            [](auto& s) -> auto& { return s.contraction; })
            .needs(naive),
    };
}

/// A condition that ends the run. A restart may change it, as it may change the last step.
template <class Get>
Key stop_key(std::string_view name, std::string_view unit, std::string_view help, const Get& get) {
    return key("time.stop." + std::string(name), unit, help, get).by_default("none").not_physical();
}

std::vector<Key> keys_of_stop() {
    const Range counts{.low = 1, .high = largest_steps}, not_negative{.low = 0};
    return {
        stop_key("collisions", "collisions",
                 "Ends the run once discs have collided so often with each other.",
                 [](auto& s) -> auto& { return s.stop.collisions; })
            .within(counts),
        stop_key("departed", "discs", "Ends the run once so many discs have left by open sides.",
                 [](auto& s) -> auto& { return s.stop.departed; })
            .within(counts)
            .needs(open_side),
        stop_key("kT_below", "mass length^2/step^2", "Ends the run once kT is below this.",
                 [](auto& s) -> auto& { return s.stop.temperature_below; })
            .within(not_negative),
        stop_key("kT_above", "mass length^2/step^2", "Ends the run once kT is above this.",
                 [](auto& s) -> auto& { return s.stop.temperature_above; })
            .within(not_negative),
        stop_key("energy_below", "mass length^2/step^2",
                 "Ends the run once the energy of motion of all discs is below this.",
                 [](auto& s) -> auto& { return s.stop.energy_below; })
            .within(not_negative),
        stop_key("energy_above", "mass length^2/step^2",
                 "Ends the run once the energy of motion of all discs is above this.",
                 [](auto& s) -> auto& { return s.stop.energy_above; })
            .within(not_negative),
        stop_key("pressure_below", "mass/step^2",
                 "Ends the run once the mean pressure between two syncs is below this.",
                 [](auto& s) -> auto& { return s.stop.pressure_below; }),
        stop_key("pressure_above", "mass/step^2",
                 "Ends the run once the mean pressure between two syncs is above this.",
                 [](auto& s) -> auto& { return s.stop.pressure_above; }),
    };
}

} // namespace

void check_stop(const SceneDraft& draft) {
    const std::string reason = reason_without_temperature(draft.scene.effects, draft.scene.n_discs);
    if (reason.empty()) return;
    for (const std::string_view key : {"time.stop.kT_below", "time.stop.kT_above",
                                       "time.stop.pressure_below", "time.stop.pressure_above"})
        if (draft.settings.has(key))
            draft.refuse({key}, fmt::format("'{}' has no meaning: {}", key, reason));
}

std::vector<Key> keys_of_time() {
    std::vector<Key> all = keys_of_steps();
    for (Key& one : keys_of_stop()) all.push_back(std::move(one));
    return all;
}

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// Scenes with effects have the bits of the plain statements of both rules, for windows and strips of several kinds, and
// the plain law's bits where an effect's parameters make it none.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "effect_runs.hpp"
#include "event_driven.hpp"
#include "one_rule.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

template <class Reference> StateHash reference_hash(const TestScene& scene, const Communicator& world) {
    StateHash hash;
    if (world.is_root()) {
        Reference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        hash = hash_of(reference.discs());
    }
    world.broadcast(hash);
    return hash;
}

/// The rule's own statement, windows of several lengths, and a run that is stopped and begun again on the way.
void check_bits(const TestScene& scene, CollisionRule rule) {
    const Communicator world = Communicator::world();
    const StateHash expected = rule == CollisionRule::one ? reference_hash<reference::OneRuleReference>(scene, world)
                                                          : reference_hash<reference::EventDrivenReference>(scene, world);
    INFO(scene.name << (rule == CollisionRule::one ? ", rule one" : ", rule all"));
    for (const std::optional<double>& window : {std::optional<double>{}, {0.3}, {2.7}}) {
        Tuning tuning;
        tuning.window = window;
        tuning.rebalance_above = window ? 0 : 1.05;
        CHECK(to_string(run(scene, rule, world, tuning).hash) == to_string(expected));
    }
    Simulation first = simulation_of(scene, rule, world);
    advance_to(first, scene.steps / 2);
    Scene again = scene_of(scene);
    again.rule = rule;
    Simulation second(again, {{first.discs().begin(), first.discs().end()}, first.micro_steps_done()}, world, {});
    advance_to(second, scene.steps);
    CHECK(to_string(second.totals().hash) == to_string(expected));
}

std::vector<TestScene> base_scenes() {
    std::vector<TestScene> scenes{gas(300, 0.05, 0.8, 501), gas(196, 0.6, 0.3, 502), break_shot(5, 0.5, 3, 0.1), cradle(12, 0.5, 0.25, 1)};
    for (TestScene& scene : scenes) {
        scene.steps = 14;
        scene.setting.sync_every = 5;
        scene.setting.micro_steps = 2;
    }
    return scenes;
}

} // namespace

TEST_CASE("effects: discs that do not meet, and discs that lose energy, have the references' bits") {
    for (TestScene scene : base_scenes()) {
        ContactEffect& contact = scene.setting.effects.contact;
        for (const auto& [kind, restitution, time] : {std::tuple(ContactKind::none, 1.0, 0.001), {ContactKind::restitution, 0.8, 0.001},
                                                      {ContactKind::restitution, 0.05, 0.01}, {ContactKind::restitution, 0.0, 0.2}}) {
            contact = {kind, restitution, time};
            for (const CollisionRule rule : {CollisionRule::one, CollisionRule::all}) check_bits(scene, rule);
        }
    }
}

TEST_CASE("effects: a restitution of 1 is the plain law to the bit") {
    const Communicator world = Communicator::world();
    for (TestScene scene : base_scenes()) {
        for (const CollisionRule rule : {CollisionRule::one, CollisionRule::all}) {
            scene.setting.effects = {};
            const Totals plain = run(scene, rule, world);
            scene.setting.effects.contact = {ContactKind::restitution, 1, 0.001};
            INFO(scene.name);
            CHECK(to_string(run(scene, rule, world).hash) == to_string(plain.hash));
            CHECK(plain.pair_collisions > 0);
        }
    }
}

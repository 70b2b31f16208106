// SPDX-License-Identifier: BSD-3-Clause
// What effects are said to have cost: a number for each that a scene names, under both rules, wherever its discs are.
#include <cmath>
#include <functional>
#include <vector>

#include <catch2/catch.hpp>

#include "carrom/simulation/effect_costs.hpp"
#include "effect_runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("effects: each one's cost is a number") {
    const std::vector<std::function<void(Effects&)>> all_kinds = {
        [](Effects& effects) { effects.contact = {ContactKind::restitution, 0.9, 0.01}; },
        [](Effects& effects) { effects.contact.kind = ContactKind::none; },
        [](Effects& effects) { effects.contact = {ContactKind::rough, 0.9, 0.01, 0.5, 0.3}; },
        [](Effects& effects) { effects.sides[0] = {SideKind::thermal, 1, 0.2, 0}; },
        [](Effects& effects) { effects.sides[2].restitution = 0.5; },
        [](Effects& effects) { effects.sides[1] = {SideKind::open, 1, 0, 0}; },
        [](Effects& effects) { effects.sides[0].kind = effects.sides[1].kind = SideKind::periodic; },
        [](Effects& effects) { effects.obstacles = {{{7, 7, 0.5}}, {{1, 2, 9, 2}}, 0.8}; },
        [](Effects& effects) { effects.classes = {{100, 1.0, 1.0}, {100, 0.9, 4.0}}; }};
    const TestScene test_scene = gas(200, 0.05, 0.8, 821);
    const std::vector<Disc> discs = reference::stored_states(test_scene.setting, test_scene.discs);
    for (const CollisionRule rule : {CollisionRule::one, CollisionRule::all}) {
        for (const auto& make : all_kinds) {
            Scene scene = scene_of(test_scene);
            scene.rule = rule;
            make(scene.effects);
            const std::vector<EffectCost> costs = effect_costs(scene, discs);
            REQUIRE(costs.size() == 1);
            CHECK(!costs[0].name.empty());
            CHECK(std::isfinite(costs[0].nanoseconds_per_wall));
            CHECK(std::isfinite(costs[0].nanoseconds_per_pair));
        }
    }
}

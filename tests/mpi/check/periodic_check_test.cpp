// SPDX-License-Identifier: BSD-3-Clause
// The self-check in boxes with periodic sides: silent on what is right, and it sees an overlap across a seam.
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "carrom/simulation/check_failure.hpp"
#include "one_engine.hpp"
#include "scene_tools.hpp"
#include "state_check.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Side periodic{SideKind::periodic, 1, 0, 0};

std::vector<InputDisc> share_of(const std::vector<InputDisc>& discs, const Communicator& world) {
    std::vector<InputDisc> mine;
    for (const InputDisc& disc : discs)
        if (disc.id % static_cast<DiscId>(world.size()) == static_cast<DiscId>(world.rank())) mine.push_back(disc);
    return mine;
}

Scene scene_of(const TestScene& test, CollisionRule rule) {
    Scene scene = test::scene_of(test);
    scene.rule = rule;
    return scene;
}

StateHash hash_after(const TestScene& test, CollisionRule rule, bool is_checked, const Communicator& world) {
    const Scene scene = scene_of(test, rule);
    Simulation simulation(scene, share_of(test.discs, world), world, {});
    if (is_checked) simulation.check_every_step(scene);
    while (simulation.step() < test.steps) simulation.advance_towards(test.steps);
    return simulation.totals().hash;
}

} // namespace

TEST_CASE("check: runs in periodic boxes break no invariant, and have their bits") {
    const Communicator world = Communicator::world();
    for (const CollisionRule rule : {CollisionRule::one, CollisionRule::all}) {
        for (const bool is_along_x : {false, true}) {
            TestScene test = gas(60, 0.4, 1.5, 61); // flies through the box once between syncs, some discs more often
            test.setting.effects.sides = {periodic, periodic, periodic, periodic};
            if (is_along_x) {
                test.setting.effects.sides[2] = {SideKind::fixed, 0.9, 0, 0};
                test.setting.effects.sides[3] = {SideKind::thermal, 1, 0.5, 0};
                test.setting.effects.contact = {ContactKind::restitution, 0.95, 0.001};
                if (rule == CollisionRule::all) test.setting.effects.gravity = {0, -0.01};
            }
            test.setting.sync_every = 12;
            test.steps = 30;
            INFO((rule == CollisionRule::one ? "rule one" : "rule all") << (is_along_x ? ", along x" : ", all round"));
            CHECK(to_string(hash_after(test, rule, true, world)) == to_string(hash_after(test, rule, false, world)));
        }
    }
}

// Two discs that were apart a micro-step ago and are 0.4 apart now, through the seam.
TEST_CASE("check: an overlap across a seam is found") {
    const Communicator world = Communicator::world();
    TestScene test = empty_scene("across the seam", 40, 1, 10);
    test.setting.effects.sides = {periodic, periodic, periodic, periodic};
    add_disc(test, 2.2, 39.9, -2, 0);
    add_disc(test, 37.8, 0.1, 2, 0);
    const Scene scene = scene_of(test, CollisionRule::one);
    std::vector<Disc> before, now;
    for (const InputDisc& input : share_of(test.discs, world)) {
        Disc& disc = before.emplace_back();
        disc.id = input.id;
        disc.x = input.x, disc.y = input.y, disc.vx = input.vx;
        now.push_back(disc);
        now.back().x += disc.vx;
        now.back().tau = 1;
    }
    StateCheck check(scene, before, 0, world);
    std::optional<CheckFailure> failure;
    {
        const std::unique_ptr<Engine> engine = make_one_engine(scene, {now, 1}, world, {});
        try {
            check.look(engine->settled(), 1, {});
        } catch (const CheckFailure& found) {
            failure = found;
        }
    }
    REQUIRE(failure);
    CHECK(failure->invariant == Invariant::overlap);
    CHECK(failure->disc == 0);
    CHECK(failure->neighbourhood.size() == 2);
}

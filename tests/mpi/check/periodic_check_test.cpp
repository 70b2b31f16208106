// SPDX-License-Identifier: BSD-3-Clause
// The self-check in boxes with periodic sides: it accepts correct runs, and finds an overlap across
// a seam.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"

#include "check/check_failure.hpp"
#include "check/state_check.hpp"
#include "scene_tools.hpp"
#include "simulation/disc_system.hpp"
#include "time_stepped/time_stepped_engine.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Boundary periodic{BoundaryKind::periodic, 1, 0, 0};

std::vector<InputDisc> share_of(const std::vector<InputDisc>& discs, const Communicator& world) {
    std::vector<InputDisc> mine;
    for (const InputDisc& disc : discs)
        if (disc.id % static_cast<DiscId>(world.size()) == static_cast<DiscId>(world.rank()))
            mine.push_back(disc);
    return mine;
}

SceneParameters scene_of(const TestScene& test, Method method) {
    SceneParameters scene = test::scene_of(test);
    scene.method = method;
    return scene;
}

StateHash hash_after(const TestScene& test, Method method, bool is_checked,
                     const Communicator& world) {
    const SceneParameters scene = scene_of(test, method);
    DiscSystem system(scene, share_of(test.discs, world), world, {});
    if (is_checked) system.check_every_step(scene);
    while (system.step() < test.steps) system.advance_towards(test.steps);
    return system.totals().hash;
}

/// The failure that the check finds if all discs fly for a micro-step without collisions, even
/// through other discs.
std::optional<CheckFailure> failure_of_flight(const TestScene& test, const Communicator& world) {
    const SceneParameters scene = scene_of(test, Method::time_stepped);
    DiscStates before, now;
    for (const InputDisc& input : share_of(test.discs, world)) {
        DiscState& disc = before.emplace_back(DiscState{});
        disc.id = input.id;
        disc.x = input.x, disc.y = input.y, disc.vx = input.vx;
        now.push_back(disc);
        now.back().x += disc.vx;
        now.back().tau = 1;
    }
    const std::unique_ptr<Engine> engine = make_time_stepped_engine(scene, {now, 1}, world, {});
    StateCheck check(scene, engine->species_table(), before, 0, world);
    try {
        check.inspect(engine->local_view(), 1, {});
    } catch (const CheckFailure& found) {
        return found;
    }
    return {};
}

} // namespace

TEST_CASE("check: runs in periodic boxes break no invariant, and have their bits") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        for (const auto& [is_along_x, are_rough] :
             {std::pair(false, false), {true, false}, {false, true}, {true, true}}) {
            TestScene test = gas(
                60, 0.4, 1.5,
                61); // between syncs discs fly through the box once, some more often
            test.setting.effects.boundaries = {periodic, periodic, periodic, periodic};
            if (is_along_x) {
                test.setting.effects.boundaries[2] = {BoundaryKind::wall, 0.9, 0, 0};
                test.setting.effects.boundaries[3] = {BoundaryKind::thermal, 1, 0.5, 0};
                test.setting.effects.contact = {ContactKind::restitution, 0.95, 0.001};
                if (method == Method::event_driven) test.setting.effects.gravity = {0, -0.01};
            }
            test.setting.effects.fixed_bodies = {
                {{0, 0, 1}, {test.setting.box_size, 9, 0.5}}, {{0, 15, 5, 18}}, 1};
            // removes discs that are in the way
            std::erase_if(test.discs, [&](const InputDisc& disc) {
                const auto far = [&](double x, double y, double reach) {
                    return std::hypot(std::remainder(disc.x - x, test.setting.box_size),
                                      std::remainder(disc.y - y, test.setting.box_size)) > reach;
                };
                return !(far(0, 0, 2.01) && far(0, 9, 1.51) && far(2.5, 16.5, 4.01));
            });
            for (std::size_t k = 0; k < test.discs.size(); ++k) test.discs[k].id = k;
            if (are_rough) {
                test.setting.effects.species = {{20, 1, 5}, {test.discs.size() - 20, 0.7, 0.3}};
                test.setting.effects.contact = {ContactKind::rough,
                                                is_along_x ? 0.95 : 1,
                                                0.001,
                                                is_along_x ? 0.3 : 1,
                                                std::numeric_limits<double>::infinity(),
                                                0.5};
            }
            test.setting.sync_every = 12;
            test.steps = 30;
            INFO((method == Method::time_stepped ? "time-stepped" : "event-driven")
                 << (is_along_x ? ", along x" : ", all round") << (are_rough ? ", rough" : ""));
            CHECK(to_string(hash_after(test, method, true, world)) ==
                  to_string(hash_after(test, method, false, world)));
        }
    }
}

// Two discs whose centres are 0.45 apart, across the seam. One micro-step before, they were 4.4
// apart.
TEST_CASE("check: an overlap across a seam is found, of discs that are as large as that") {
    for (const double radius : {1.0, 0.23, 0.22}) {
        TestScene test = empty_scene("across the seam", 40, 1, 10);
        test.setting.effects.boundaries = {periodic, periodic, periodic, periodic};
        add_disc(test, 2.2, 39.9, -2, 0);
        add_disc(test, 37.8, 0.1, 2, 0);
        if (radius < 1) test.setting.effects.species = {{1, radius, 1}, {1, radius, 3}};
        const auto failure = failure_of_flight(test, Communicator::world());
        CHECK(failure.has_value() == (2 * radius > std::hypot(0.4, 0.2)));
        if (!failure) continue;
        CHECK(failure->invariant == Invariant::overlap);
        CHECK(failure->disc == 0);
        CHECK(failure->discs_around.size() == 2);
    }
}

TEST_CASE("check: a disc in an obstacle is found, across a seam too") {
    TestScene test = empty_scene("into a body", 40, 1, 10);
    test.setting.effects.boundaries = {periodic, periodic, periodic, periodic};
    test.setting.effects.fixed_bodies = {{{20, 20, 1}, {39, 10, 2}}, {}, 1};
    add_disc(test, 4, 10, -2, 0); // flies until it touches the second obstacle's image
    add_disc(test, 10, 30, 1, 0);
    CHECK_FALSE(failure_of_flight(test, Communicator::world()));
    test.discs[0].vx = -2.5;
    const auto failure = failure_of_flight(test, Communicator::world());
    REQUIRE(failure);
    CHECK(failure->invariant == Invariant::clear);
    CHECK(failure->disc == 0);
    CHECK(std::string(failure->what()).find("overlaps fixed disc 2 by 0.5;") != std::string::npos);
}

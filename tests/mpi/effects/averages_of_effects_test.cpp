// SPDX-License-Identifier: BSD-3-Clause
// Averages of a run under effects, where exact values are known.
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "averaging.hpp"
#include "effect_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

Averages averages_of(const TestScene& scene, Method method = Method::event_driven) {
    const Communicator world = Communicator::world();
    DiscSystem system = system_of(scene, method, world);
    Averaging averaging(scene, system, world);
    averaging.advance_to(scene.steps);
    return averaging.averages();
}

/// Discs that never collide, all with the same speed.
TestScene swarm(double speed, std::int64_t steps) {
    TestScene scene = gas(300, 0.05, speed, 611);
    for (InputDisc& disc : scene.discs) {
        const double factor = speed / std::hypot(disc.vx, disc.vy);
        disc.vx *= factor;
        disc.vy *= factor;
    }
    scene.setting.effects.contact.kind = ContactKind::none;
    scene.setting.sync_every = 8;
    scene.steps = steps;
    return scene;
}

} // namespace

TEST_CASE("effects: averages of speeds over a thermal floor under gravity are Maxwell's") {
    TestScene scene = gas(1500, 0.02, 0.4, 612);
    const double temperature = 0.2;
    scene.setting.effects.contact.kind = ContactKind::none;
    scene.setting.effects.gravity = {0, -0.01};
    scene.setting.effects.boundaries[2] = {BoundaryKind::thermal, 1, temperature, 0};
    const Communicator world = Communicator::world();
    DiscSystem system = system_of(scene, Method::event_driven, world);
    advance_to(system, 2000); // several flights of each disc
    Averaging averaging(scene, system, world);
    averaging.advance_to(4000);
    const Averages averages = averaging.averages();
    CHECK(averages.mean_speed.value ==
          Approx(std::sqrt(std::numbers::pi * temperature / 2)).epsilon(0.03));
    CHECK(averages.speed_kurtosis.value == Approx(2).epsilon(0.06));
    CHECK(averages.collision_frequency.value == 0);
    CHECK(std::isnan(averages.wall_pressure.value));
}

TEST_CASE("effects: averages of what is slowed down, leaves, or flies among obstacles") {
    // With drag the mean speed is v (1 - exp(-c t)) / (c t), because all discs have the same speed.
    TestScene slowed = swarm(0.5, 320);
    set_drag(slowed, 0.005);
    const Averages of_slowed = averages_of(slowed);
    CHECK(of_slowed.mean_speed.value ==
          Approx(0.5 * -std::expm1(-1.6) / 1.6).epsilon(2e-3)); // trapezoids with steps of 8 to 16
    CHECK(of_slowed.speed_kurtosis.value == Approx(1).epsilon(1e-12));

    // If discs leave, the mean speed of the others does not change.
    TestScene leaving = swarm(0.5, 160);
    leaving.setting.effects.boundaries[0].kind = BoundaryKind::open;
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        const Averages of_leaving = averages_of(leaving, method);
        CHECK(of_leaving.mean_speed.value == Approx(0.5).epsilon(1e-12));
        CHECK(of_leaving.speed_kurtosis.value == Approx(1).epsilon(1e-12));
        CHECK(std::isnan(of_leaving.collision_frequency.value));
    }

    TestScene lorentz = swarm(0.5, 160);
    const double size = lorentz.setting.box_size;
    lorentz.setting.effects.fixed_bodies = {{{0.3 * size, 0.4 * size, 0.1 * size}},
                                            {{0.5 * size, 0.8 * size, 0.8 * size, 0.6 * size}},
                                            1};
    make_room_for_obstacles(lorentz);
    const Averages among_obstacles = averages_of(lorentz);
    CHECK(among_obstacles.mean_speed.value == Approx(0.5).epsilon(1e-12));
    CHECK(among_obstacles.collision_frequency.value == 0);
}

TEST_CASE("effects: the frequency of collisions is what is counted, whatever the effects") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(300, 0.3, 0.5, 613);
    scene.steps = 96;
    scene.setting.sync_every = 16;
    scene.setting.effects.gravity = {0, -0.005};
    scene.setting.effects.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.02};
    set_drag(scene, 0.005);
    DiscSystem system = system_of(scene, Method::event_driven, world);
    Averaging averaging(scene, system, world);
    averaging.advance_to(scene.steps);
    const Totals totals = system.totals();
    CHECK(totals.pair_collisions > 300);
    CHECK(averaging.averages().collision_frequency.value ==
          Approx(2 * static_cast<double>(totals.pair_collisions) / (300.0 * 96)).epsilon(1e-12));
}

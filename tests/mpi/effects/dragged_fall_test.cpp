// SPDX-License-Identifier: BSD-3-Clause
// Known results for discs that fall under drag, in long double.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

using Long = long double;
constexpr double g = 0.01, rate = 0.05;

/// One disc of radius 1 that starts from rest at a height above the floor.
TestScene ball(double height, double restitution) {
    TestScene scene = empty_scene("ball in air", 128, 1, 1);
    add_disc(scene, 64, 1 + height, 0.0625, 0);
    scene.setting.effects.gravity = {0, -g};
    scene.setting.effects.boundaries[2].restitution = restitution;
    scene.setting.sync_every = 50;
    set_drag(scene, rate);
    return scene;
}

/// The height after a time of a body that starts upwards from 0 with `speed`.
Long height_after(Long time, Long speed) {
    return (speed + g / Long(rate)) * -std::expm1(-rate * time) / rate - g / Long(rate) * time;
}
Long speed_after(Long time, Long speed) {
    return speed + (speed + g / Long(rate)) * std::expm1(-rate * time);
}

/// The time at which a body reaches `depth` on the way down, by bisection. At `late` it is deeper.
Long time_down(Long depth, Long speed, Long late) {
    Long early = speed > 0 ? std::log1p(rate * speed / g) / rate : 0; // time at the top
    for (int k = 0; k < 200; ++k) {
        const Long middle = (early + late) / 2;
        (height_after(middle, speed) > -depth ? early : late) = middle;
    }
    return early;
}

/// The only disc, in the box's coordinates; one rank has it. **Collective.**
DiscState only_disc(const DiscSystem& system, const Communicator& world) {
    std::vector<DiscState> all;
    stream_to_root(
        world, system.shown(),
        [&](std::span<const DiscState> some) { all.insert(all.end(), some.begin(), some.end()); },
        10);
    world.broadcast(all);
    return all.at(0);
}

} // namespace

TEST_CASE("effects: a ball falls through the air as the formula says, and no faster than g / c") {
    const Communicator world = Communicator::world();
    DiscSystem system = system_of(ball(120, 1), Method::event_driven, world);
    // Some of these steps are between syncs
    for (const std::int64_t step : {20, 50, 123, 400, 600}) {
        advance_to(system, step);
        const DiscState disc = only_disc(system, world);
        const auto time = static_cast<Long>(step);
        CHECK(disc.y == Approx(static_cast<double>(121 + height_after(time, 0))).epsilon(1e-13));
        CHECK(disc.vy == Approx(static_cast<double>(speed_after(time, 0))).epsilon(1e-13));
        CHECK(disc.x == Approx(64 + static_cast<double>(-std::expm1(-rate * time) / rate) * 0.0625)
                            .epsilon(1e-13));
        if (step == 600)
            // differs from the final speed by exp(-30)
            CHECK(disc.vy == Approx(-g / rate).epsilon(1e-12));
    }
}

TEST_CASE("effects: a ball in the air bounces when the formula says") {
    const Communicator world = Communicator::world();
    for (const double restitution : {1.0, 0.8}) {
        TestScene scene = ball(50, restitution);
        // A disc at rest bounces once in this time
        scene.setting.effects.contact.contact_time = 0.02;
        DiscSystem system = system_of(scene, Method::event_driven, world);
        std::vector<Collision> log, all;
        system.log_to(&log);
        advance_to(system, 700);
        stream_to_root(
            world, std::span<const Collision>(log),
            [&](std::span<const Collision> some) {
                all.insert(all.end(), some.begin(), some.end());
            },
            1000);
        world.broadcast(all);
        Long expected = time_down(50, 0, 2000), speed = -speed_after(expected, 0) * restitution;
        double worst = 0;
        int n = 0;
        for (const Collision& bounce : all) {
            if (speed * 2 / g < 1) break; // flights of such a speed take less than a step
            worst = std::max(worst,
                             std::fabs(static_cast<double>(static_cast<Long>(bounce.micro_step) +
                                                           bounce.time - expected)));
            const Long flight = time_down(0, speed, 2 * speed / g);
            expected += flight;
            speed = -speed_after(flight, speed) * restitution;
            ++n;
        }
        CHECK(n >= 10);
        CHECK(worst < 1e-9);
    }
}

TEST_CASE("effects: a ball in the air comes to rest in bounded time; with ever less air it bounces "
          "as without") {
    const Communicator world = Communicator::world();
    TestScene scene = ball(5, 0.5);
    scene.steps = 400;
    scene.setting.effects.contact.contact_time = 0.01;
    const Totals rest = run(scene, Method::event_driven, world);
    CHECK(static_cast<double>(rest.wall_collisions) <
          1.01 * 400 / 0.01); // flights that start with g t / 2 are a little shorter than t
    CHECK(rest.wall_collisions > 100);
    CHECK(rest.kinetic_energy + rest.potential_energy - g < 0.05 * 0.02 * g);

    scene = ball(47, 0.8); // a start at 50 would reach the floor at a sync, which counts as a touch
    DiscSystem thin = [&] {
        set_drag(scene, 1e-13);
        return system_of(scene, Method::event_driven, world);
    }();
    scene.setting.effects.drag = 0;
    DiscSystem none = system_of(scene, Method::event_driven, world);
    for (DiscSystem* system : {&thin, &none}) advance_to(*system, 700);
    const DiscState in_thin = only_disc(thin, world), in_none = only_disc(none, world);
    CHECK(in_thin.wall_collisions == in_none.wall_collisions);
    CHECK(in_none.wall_collisions > 5);
    CHECK(in_thin.y == Approx(in_none.y).margin(1e-8));
    CHECK(in_thin.vy == Approx(in_none.vy).margin(1e-9));
}

TEST_CASE("effects: a gas in the air loses energy at the rate of twice that of its motion") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(400, 0.2, 0.5, 606);
    scene.setting.effects.gravity = {0.004, -0.01};
    scene.setting.sync_every = 16;
    set_drag(scene, 0.01);
    DiscSystem system = system_of(scene, Method::event_driven, world);
    const Totals start = system.totals();
    // d(K + U)/dt = -2 c K, integrated by Simpson's rule. Elastic collisions do not make K jump.
    double integral = 0;
    constexpr int last = 40;
    for (int step = 0; step <= last; ++step) {
        advance_to(system, step);
        const double weight = step == 0 || step == last ? 1.0 : step % 2 == 1 ? 4.0 : 2.0;
        integral += weight / 3 * system.totals().kinetic_energy;
    }
    const Totals end = system.totals();
    const double lost = (start.kinetic_energy + start.potential_energy) -
                        (end.kinetic_energy + end.potential_energy);
    CHECK(lost == Approx(2 * 0.01 * integral).epsilon(1e-4));
    CHECK(end.overlapping_pairs == 0);
    CHECK(end.pair_collisions > 100);
}

TEST_CASE("effects: what a wall pushes through the air goes with it") {
    const Communicator world = Communicator::world();
    TestScene scene = empty_scene("pushed", 128, 1, 1);
    add_disc(scene, 20, 64, 0, 0);
    scene.setting.effects.boundaries[0] = {BoundaryKind::moving, 0.5, 0, 0.05};
    scene.setting.effects.contact.contact_time = 0.05;
    set_drag(scene, rate);
    DiscSystem system = system_of(scene, Method::event_driven, world);
    advance_to(system, 1000);
    const DiscState disc = only_disc(system, world);
    CHECK(disc.x - 1 == Approx(0.05 * 1000).margin(1e-6)); // the disc hops by c u t^2 / 8
    CHECK(disc.vx == Approx(0.05).margin(1e-4));
    CHECK(disc.wall_collisions > 1000);
}

// SPDX-License-Identifier: BSD-3-Clause
// Walls that oscillate: the bits of the reference, and a ball on a shaken plate compared with its
// path in long double.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "reference_bits.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

using Long = long double;

Boundary shaken(double amplitude, double period, double phase, double restitution) {
    return {BoundaryKind::oscillating, restitution, 0, 0, amplitude, period, phase};
}

/// A ball above a plate, computed with small steps and bisection. Heights are those of the ball's
/// lowest point.
struct Ball {
    Long height, speed, gravity, amplitude, period, phase, restitution, time = 0;
    int n_hits = 0;

    Long angle(Long at) const { return 2 * std::numbers::pi_v<Long> * at / period + phase; }
    Long plate(Long at) const { return amplitude * std::sin(angle(at)); }
    Long plate_speed(Long at) const {
        return amplitude * 2 * std::numbers::pi_v<Long> / period * std::cos(angle(at));
    }
    /// The largest factor by which a hit multiplies errors: they shift the time of a later hit, so
    /// also the speed of the plate at that hit.
    Long growth() const {
        const Long rate = 2 * std::numbers::pi_v<Long> / period;
        return 2 + 2 * (1 + restitution) * amplitude * rate * rate / gravity;
    }
    Long height_at(Long s) const { return height + speed * s - gravity / 2 * s * s; }
    void move(Long s) {
        height = height_at(s);
        speed -= gravity * s;
        time += s;
    }
    void run_to(Long end) {
        const Long step = period / 1000;
        for (Long s = 0; time + s < end;) {
            Long low = s, high = s += step;
            if (height_at(s) > plate(time + s)) continue;
            for (int k = 0; k < 80; ++k) {
                const Long middle = (low + high) / 2;
                (height_at(middle) > plate(time + middle) ? low : high) = middle;
            }
            if (time + low > end) break;
            move(low);
            speed = plate_speed(time) + restitution * (plate_speed(time) - speed);
            ++n_hits;
            s = 0;
        }
        move(end - time);
    }
};

/// A disc of radius 1 in a box of 40, near the wall `side`, to which gravity pulls it.
TestScene ball_before(std::size_t side, const Ball& ball) {
    TestScene scene = empty_scene("ball on a plate", 40, 1, 400);
    const double sign = side % 2 == 0 ? 1 : -1, line = side % 2 == 0 ? 1 : 39;
    const double place = line + sign * static_cast<double>(ball.height),
                 speed = sign * static_cast<double>(ball.speed);
    if (side < 2)
        add_disc(scene, place, 20, speed, 0);
    else
        add_disc(scene, 20, place, 0, speed);
    Effects& effects = scene.setting.effects;
    // A sine of the opposite sign is one half of a period later.
    effects.boundaries[side] = shaken(
        static_cast<double>(ball.amplitude), static_cast<double>(ball.period),
        static_cast<double>(ball.phase) + (side % 2 == 0 ? 0 : std::numbers::pi),
        static_cast<double>(ball.restitution));
    (side < 2 ? effects.gravity.x : effects.gravity.y) = -sign * static_cast<double>(ball.gravity);
    effects.contact.contact_time = 1e-6;
    return scene;
}

} // namespace

TEST_CASE("oscillation: a ball on a plate is where a plain search says, before any side") {
    const Communicator world = Communicator::world();
    const std::vector<Ball> balls{{5, 0, 0.02, 0.5, 13, 0, 0.8},
                                  {3, 0.1, 0.1, 0.05, 0.7, 1, 0.9},  // a fast plate
                                  {2, -0.2, 0.05, 1.5, 160, 2, 0.9}, // a slow plate
                                  {4, 0.2, 0.02, 0.3, 40, 4, 1}};
    for (const std::size_t side : {0u, 1u, 2u, 3u}) {
        for (Ball ball : balls) {
            INFO("side " << side << ", period " << static_cast<double>(ball.period));
            const TestScene scene = ball_before(side, ball);
            const double sign = side % 2 == 0 ? 1 : -1, line = side % 2 == 0 ? 1 : 39;
            DiscSystem system = system_of(scene, Method::event_driven, world);
            double error = 1e-13;
            for (std::int64_t step = 4; step <= 160 && error < 1e-6; step += 4) {
                advance_to(system, step);
                const int n_before = ball.n_hits;
                ball.run_to(static_cast<Long>(step));
                CHECK(system.totals().wall_collisions == static_cast<std::uint64_t>(ball.n_hits));
                error *= std::pow(static_cast<double>(ball.growth()), ball.n_hits - n_before);
                for (const DiscState& disc : system.shown()) {
                    const double height = sign * ((side < 2 ? disc.x : disc.y) - line),
                                 speed = sign * (side < 2 ? disc.vx : disc.vy);
                    CHECK(std::fabs(height - static_cast<double>(ball.height)) < error);
                    CHECK(std::fabs(speed - static_cast<double>(ball.speed)) < error);
                }
            }
            CHECK(ball.n_hits >= 3);
        }
    }
}

// If the plate falls more slowly than the disc would, the disc stays on it.
TEST_CASE("oscillation: a disc that never leaves the plate goes with it") {
    const Communicator world = Communicator::world();
    for (const double restitution : {0.0, 0.5}) {
        TestScene scene = empty_scene("carried disc", 40, 1, 160);
        add_disc(scene, 20, 1.3, 0, 0);
        Effects& effects = scene.setting.effects;
        // the plate's acceleration is 0.0123
        effects.boundaries[2] = shaken(0.5, 40, 0, restitution);
        effects.gravity.y = -0.02;
        effects.contact.contact_time = 0.25;
        SceneParameters checked = scene_of(scene);
        checked.method = Method::event_driven;
        DiscSystem system = system_of(scene, Method::event_driven, world);
        system.check_every_step(checked);
        advance_to(system, 80);
        for (std::int64_t step = 80; step <= 160; step += 7) {
            advance_to(system, step);
            const double angle = 2 * std::numbers::pi * static_cast<double>(step) / 40,
                         speed = 0.5 * 2 * std::numbers::pi / 40 * std::cos(angle);
            for (const DiscState& disc : system.shown()) {
                CHECK(disc.y - 1 == Approx(0.5 * std::sin(angle)).margin(1e-3));
                CHECK(disc.vy == Approx(speed).margin(0.0325 * 0.25));
            }
        }
        // Each contact time has little more than one collision.
        CHECK(system.totals().wall_collisions < 960); // 1.5 times 160 / 0.25
    }
}

namespace {

/// Small gases and a small rack, because the reference searches all pairs.
std::vector<TestScene> few_discs() {
    std::vector<TestScene> scenes{gas(60, 0.1, 0.8, 531), gas(49, 0.5, 0.3, 532),
                                  break_shot(4, 0.5, 3, 0.1)};
    for (TestScene& scene : scenes) {
        scene.steps = 14;
        scene.setting.sync_every = 5;
        scene.setting.micro_steps = 2;
    }
    return scenes;
}

void check_oscillating_bits(TestScene scene, const Effects& effects) {
    scene.setting.effects = effects;
    set_oscillation(scene.setting);
    check_bits(scene, Method::event_driven);
}

} // namespace

TEST_CASE("oscillation: walls have the reference's bits, alone and with gravity") {
    for (const TestScene& scene : few_discs()) {
        Effects effects;
        effects.boundaries[2] = shaken(0.4, 1.7, 0, 1);
        check_oscillating_bits(scene, effects);
        effects.gravity = {-0.01, -0.05};
        effects.contact = {ContactKind::restitution, 0.85, 0.02};
        effects.boundaries = {Boundary{BoundaryKind::moving, 1, 0, 0.02}, shaken(0.2, 31.4, 0.3, 0),
                              shaken(0.4, 1.7, 0, 0.8), shaken(0.3, 0.21, 1, 0.9)};
        check_oscillating_bits(scene, effects);
    }
}

TEST_CASE("oscillation: walls have the reference's bits beside periodic sides and rough discs") {
    for (const TestScene& scene : few_discs()) {
        Effects effects;
        effects.boundaries[2] = shaken(0.4, 3.3, 0, 0.9);
        effects.gravity.y = -0.03;
        effects.contact = {ContactKind::rough, 0.9, 0.02, 0.4, 0.3, 0.5};
        check_oscillating_bits(scene, effects);
        effects.contact = {};
        effects.boundaries[0] = effects.boundaries[1] = {BoundaryKind::periodic, 1, 0, 0};
        check_oscillating_bits(scene, effects);
    }
}

TEST_CASE("oscillation: an amplitude of 0 is a wall at rest to the bit") {
    const Communicator world = Communicator::world();
    for (TestScene scene : few_discs()) {
        const Totals plain = run(scene, Method::event_driven, world);
        scene.setting.effects.boundaries[2] = shaken(0, 3, 1, 1);
        CHECK(to_string(run(scene, Method::event_driven, world).hash) == to_string(plain.hash));
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Gases: ordinary, at rest, fast, overlapping, and with tiny speeds.
#include <array>
#include <limits>

#include "scene_tools.hpp"

namespace carrom::test {

std::vector<TestScene> gases() {
    std::vector<TestScene> scenes;
    std::uint64_t seed = 100;
    for (const double packing : {0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.7}) {
        for (const double speed : {0.001, 0.05, 0.3, 1.0, 5.0, 40.0}) {
            for (const std::size_t n : {std::size_t{4}, std::size_t{25}, std::size_t{49}}) {
                TestScene scene = gas(n, packing, speed, ++seed);
                scene.setting.micro_steps = std::array{1, 1, 4, 3}[seed % 4];
                scene.setting.sync_every = std::array{64, 1, 5, 7, 16}[seed % 5];
                scene.steps = 40 / scene.setting.micro_steps;
                scenes.push_back(seed % 2 == 0 ? shuffled(scene, seed) : scene);
            }
        }
    }
    return scenes;
}

std::vector<TestScene> still_gases() {
    std::vector<TestScene> scenes;
    std::uint64_t seed = 300;
    for (const double speed : {0.0, 0.01, 0.7, 3.0, 25.0, 400.0}) {
        for (const double packing : {0.1, 0.35, 0.7}) {
            TestScene scene = gas(49, packing, 0, ++seed);
            scene.name = "still, one fast: " + scene.name + ", fast speed " + number(speed);
            scene.discs[seed % 49].vx = speed;
            scene.discs[seed % 49].vy = -0.37 * speed;
            scene.setting.sync_every = std::array{64, 3}[seed % 2];
            scenes.push_back(shuffled(scene, seed));
        }
    }
    return scenes;
}

std::vector<TestScene> fast_scenes() {
    std::vector<TestScene> scenes;
    std::uint64_t seed = 400;
    for (const double box_size : {50.0, 200.0, 20000.0}) {
        for (const std::size_t n : {std::size_t{3}, std::size_t{20}, std::size_t{60}}) {
            for (const std::int64_t micro_steps : {1, 2, 10}) {
                TestScene scene = legacy_like(n, box_size, 1, ++seed);
                scene.name += ", " + std::to_string(micro_steps) + " micro-steps";
                scene.setting.micro_steps = micro_steps;
                scene.setting.sync_every = std::array{64, 4, 1}[seed % 3];
                scene.steps = 60 / micro_steps;
                scenes.push_back(seed % 2 == 0 ? shuffled(scene, seed) : scene);
            }
        }
    }
    TestScene cascade = legacy_like(400, 20000, 1, ++seed);
    cascade.steps = 20;
    scenes.push_back(cascade);
    return scenes;
}

std::vector<TestScene> overlaps() {
    std::vector<TestScene> scenes;
    Random random(500);
    for (const std::size_t n : {std::size_t{2}, std::size_t{5}, std::size_t{20}, std::size_t{60}}) {
        for (const double speed : {0.05, 1.0, 6.0}) {
            TestScene scene = empty_scene(
                "overlaps of " + std::to_string(n) + ", speed " + number(speed), 12, 1, 40);
            for (std::size_t i = 0; i < n; ++i) {
                const double x = random.uniform(1, 11), y = random.uniform(1, 11);
                add_disc(scene, x, y);
            }
            set_speeds(scene, speed, random);
            // Every third disc is exactly at the position of the one before it, and every sixth has
            // the same velocity, too.
            for (std::size_t i = 2; i < n; i += 3) {
                scene.discs[i].x = scene.discs[i - 1].x;
                scene.discs[i].y = scene.discs[i - 1].y;
                if (i % 6 != 2) continue;
                scene.discs[i].vx = scene.discs[i - 1].vx;
                scene.discs[i].vy = scene.discs[i - 1].vy;
            }
            scene.setting.sync_every = std::array<std::int64_t, 3>{64, 1, 6}[scenes.size() % 3];
            scenes.push_back(shuffled(scene, 500 + n));
        }
    }
    // Overlaps near the tolerance: from 2^-30 of a diameter deeper to as much apart.
    for (const double depth : {0x1p-30, 1.5e-12, 1e-12, 0.5e-12, 0x1p-52, 0.0, -0x1p-52, -1e-12}) {
        TestScene scene = empty_scene("overlap of " + number(depth) + " diameters", 64, 1, 20);
        add_disc(scene, 31, 32, 0.25, 0);
        add_disc(scene, 33 - 2 * depth, 32, -0.25, 0);
        add_disc(scene, 31, 20, 0.25, 0.125);
        add_disc(scene, 31 + 1.2, 20 + 1.6 * (1 - depth), -0.25, -0.5);
        scenes.push_back(scene);
    }
    return scenes;
}

std::vector<TestScene> tiny_velocities() {
    std::vector<TestScene> scenes;
    const std::array<double, 8> speeds = {0.0,    -0.0,   std::numeric_limits<double>::denorm_min(),
                                          1e-310, 1e-300, 1e-160,
                                          1e-20,  0x1p-30};
    std::uint64_t seed = 600;
    for (const double largest : speeds) {
        Random random(++seed);
        TestScene scene = empty_scene("tiny velocities, case " + std::to_string(seed), 16, 1, 30);
        add_disc(scene, 1, 1);   // a disc at two walls
        add_disc(scene, 15, 15); // a disc at the other two walls
        add_disc(scene, 3, 1);   // touches the first
        add_disc(scene, 15 - 0.5e-8, 3);
        add_gas(scene, 20, random);
        for (InputDisc& disc : scene.discs) {
            const double signs = random.uniform(0, 4);
            disc.vx = signs < 2 ? largest : -largest;
            disc.vy = signs < 1 ? -0.0 : signs < 3 ? -largest : largest;
        }
        scene.setting.sync_every = std::array{64, 1}[seed % 2];
        scenes.push_back(scene);
        // The same scene with one disc of ordinary speed.
        scene.name += " with one ordinary disc";
        scene.discs.back().vx = 1.5;
        scene.discs.back().vy = 0.75;
        scenes.push_back(shuffled(scene, seed));
    }
    return scenes;
}

} // namespace carrom::test

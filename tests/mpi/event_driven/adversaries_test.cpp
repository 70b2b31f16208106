// SPDX-License-Identifier: BSD-3-Clause
// Scenes in which block runs fail most easily: collision cascades that cross any distance in zero
// time, hits from beyond a block's halo, equal times on every boundary, and speeds above any
// bound. A further test shows that results are wrong without the validation.
#include <cmath>
#include <string>

#include "catch.hpp"
#include "event_driven_runs.hpp"
#include "scene_tools.hpp"
#include "shape_parts.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// A line of touching discs at rest with room at both ends; the first one is hit.
TestScene struck_line(std::size_t n, bool along_y) {
    TestScene scene = empty_scene("struck line of " + std::to_string(n),
                                  static_cast<double>(n) + 24, 0.5, 12);
    const double middle = scene.setting.box_size / 2;
    add_disc(scene, 3, middle, 1.25, 0);
    for (std::size_t i = 0; i < n; ++i) add_disc(scene, 12 + static_cast<double>(i), middle);
    return along_y ? transposed(scene) : shuffled(scene, n);
}

/// Many short lines of touching discs among discs at rest. Each line is hit at one end, half-way
/// through a window.
TestScene struck_lines(std::uint64_t seed) {
    Random random(seed);
    TestScene scene = empty_scene("struck lines, seed " + std::to_string(seed), 96, 0.5, 16);
    for (int line = 0; line < 15; ++line) {
        const double y = 4 + 6.0 * line;
        const std::size_t n = 12 + random.index(40);
        const double x = 6 + std::floor(random.uniform(0, 30));
        add_disc(scene, x - random.uniform(2, 5), y, random.uniform(0.5, 3),
                 random.uniform(-0.02, 0.02));
        for (std::size_t i = 0; i < n; ++i) add_disc(scene, x + static_cast<double>(i), y);
        for (int k = 0; k < 5; ++k)
            add_disc(scene, 2 + 18 * k + random.uniform(0, 16), y + 3, random.uniform(-1, 1),
                     random.uniform(-1, 1));
    }
    TestScene dealt = shuffled(scene, seed);
    return seed % 2 == 0 ? transposed(dealt) : dealt;
}

/// A fast slab that runs into a still lattice.
TestScene shock() {
    TestScene scene = empty_scene("shock", 60, 0.5, 8);
    for (int column = 0; column < 30; ++column) {
        for (int row = 0; row < 20; ++row) {
            const double shift = 0.001 * ((row * 7 + column * 13) % 11);
            add_disc(scene, 2 + 1.25 * column + shift, 2 + 1.25 * row - shift,
                     column < 10 ? 5 + shift : 0, 0);
        }
    }
    return shuffled(scene, 77);
}

/// Rows of discs that nearly touch their six neighbours; some discs get a velocity.
TestScene tight_hexagons() {
    TestScene scene = empty_scene("hexagonal lattice, gaps of 1e-12", 40, 0.5, 4);
    const double spacing = 1 + 1e-12;
    Random random(5);
    for (int row = 0; row < 20; ++row) {
        for (int column = 0; column < 20; ++column) {
            const double x = 8 + spacing * (column + 0.5 * (row % 2)),
                         y = 8 + spacing * row * std::sqrt(0.75) * (1 + 1e-12);
            const bool is_kicked = random.index(40) == 0;
            add_disc(scene, x, y, is_kicked ? random.uniform(-1, 1) : 0,
                     is_kicked ? random.uniform(-1, 1) : 0);
        }
    }
    return scene;
}

/// Every contact is at a multiple of 1/8, and so are the ends of windows.
TestScene dyadic_ties() {
    TestScene scene = lattice(20, 1.5);
    scene.name = "dyadic ties";
    for (std::size_t i = 0; i < scene.discs.size(); ++i)
        scene.discs[i].vx = (i % 20) % 2 == 0 ? 0.5 : -0.5;
    scene.steps = 12;
    return shuffled(scene, 31);
}

/// One disc 10000 times faster than the others.
TestScene one_fast() {
    TestScene scene = gas(400, 0.3, 0.001, 55);
    scene.discs[123].vx = 7;
    scene.discs[123].vy = 7.1;
    scene.name = "one disc 10000 times faster";
    scene.steps = 20;
    return scene;
}

/// A dense cloud in a corner of a wide box.
TestScene one_strip() {
    TestScene scene = gas(400, 0.5, 0.5, 56);
    scene.setting.box_size *= 6;
    scene.name = "everything in one strip";
    scene.steps = 10;
    return scene;
}

std::vector<TestScene> adversaries() {
    std::vector<TestScene> scenes = {struck_line(1000, false),
                                     struck_line(300, true),
                                     shock(),
                                     tight_hexagons(),
                                     dyadic_ties(),
                                     one_fast(),
                                     one_strip(),
                                     break_shot(20, 0.5, 15, 0.2)};
    for (std::uint64_t seed = 1; seed <= 12; ++seed) scenes.push_back(struck_lines(seed));
    return scenes;
}

} // namespace

TEST_CASE("exact: adversaries have the reference's bits") {
    const Communicator world = Communicator::world();
    unsigned seed = 0;
    std::size_t number = 0;
    for (TestScene scene : adversaries()) {
        if (!is_wanted(scene, number++)) continue;
        const EventDrivenResult expected = expected_of(scene, world,
                                                       shape_part() ? 1000000 : 3000000);
        CHECK(expected.pair_collisions > 0);
        const double time = diameter_time(scene);
        for (const Shape& shape : {small_blocks(0.125 * time, 2, 2), small_blocks(time, 2, 2),
                                   small_blocks(4 * time, 3, 1), small_blocks(0.125, 2, 3)}) {
            INFO(scene.name << ", N = " << scene.discs.size() << ", window "
                            << *shape.tuning.window);
            CHECK(run_event_driven(scene, shape, world, ++seed) == expected);
        }
    }
}

TEST_CASE("exact: without the validation the struck lines go wrong") {
    const Communicator world = Communicator::world();
    int n_wrong = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        if (shape_part() && n_wrong > 3) break; // enough failures have been found
        TestScene scene = struck_lines(seed);
        const EventDrivenResult expected = expected_of(scene, world, 3000000);
        Shape shape = small_blocks(2, 1, 1);
        shape.exact.is_validated = false;
        n_wrong += !(run_event_driven(scene, shape, world, 1) == expected);
        shape.exact.is_validated = true;
        CHECK(run_event_driven(scene, shape, world, 1) == expected);
    }
    CHECK(n_wrong > 3);
}

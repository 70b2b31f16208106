// SPDX-License-Identifier: BSD-3-Clause
// Sheared sides: the bits of the references of both methods, which search all pairs of all moving
// images, and a collision with an image by the laws of mechanics.
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"
#include "periodic_bits.hpp"
#include "periodic_scenes.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Boundary sliding{BoundaryKind::sheared, 1, 0, 0};

/// The scene between sheared sides. The row above moves at `speed` times the discs' own speeds.
TestScene sheared(const TestScene& base, double speed) {
    TestScene scene = moved_along(base, both);
    scene.setting.effects.boundaries = {periodic, periodic, sliding, sliding};
    double fastest = 0;
    for (const InputDisc& disc : scene.discs)
        fastest = std::max(fastest, std::hypot(disc.vx, disc.vy));
    scene.setting.effects.shear = speed * fastest / scene.setting.box().y;
    scene.name += ", sheared " + number(speed);
    return scene;
}

std::vector<TestScene> sheared_scenes() {
    std::vector<TestScene> scenes;
    for (const TestScene& base : base_scenes())
        scenes.push_back(sheared(base, scenes.size() % 2 == 0 ? -2.1 : 0.3));
    return scenes;
}

} // namespace

TEST_CASE("shear: the time-stepped method has the reference's bits") {
    for (const TestScene& scene : sheared_scenes()) check_bits(scene, Method::time_stepped);
}

TEST_CASE("shear: the event-driven method has the reference's bits") {
    for (const TestScene& scene : sheared_scenes()) check_bits(scene, Method::event_driven);
}

TEST_CASE("shear: rows that have gone round many boxes have the references' bits") {
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = sheared(base_scenes()[0], 6);
        scene.steps = 60;
        check_bits(scene, method);
    }
}

TEST_CASE("shear: discs that lose energy, mixtures and rough discs have the references' bits") {
    std::vector<TestScene> scenes = mixtures();
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{4}})
        scenes.push_back(base_scenes()[k]);
    for (std::size_t k = 0; k < scenes.size(); ++k) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            TestScene scene = sheared(scenes[k], k % 2 == 0 ? 0.7 : -1.3);
            if (k % 2 == 0) scene.setting.effects.contact = {ContactKind::restitution, 0.8, 0.002};
            check_bits(scene, method);
            scene.setting.effects.contact = k % 2 == 0 ? rough(1, 1, 1e300) : rough(0.9, 0.4, 0.3);
            if (scene.setting.effects.species.empty() && k % 2 == 1) split_into_species(scene);
            check_bits(scene, method);
        }
    }
}

TEST_CASE("shear: at the rate 0 sheared sides are periodic ones, to the bit") {
    const Communicator world = Communicator::world();
    for (const TestScene& base : base_scenes()) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            const TestScene at_rest = moved_along(base, both), scene = sheared(base, 0);
            CHECK(to_string(run(scene, method, world).hash) ==
                  to_string(run(at_rest, method, world).hash));
        }
    }
}

// A disc rests near the top. Another one rests near the bottom, and the row above carries its image
// past the first one, with the velocity (1, 0). They touch with the line of centres at 45 degrees.
// Equal discs exchange the velocity components along that line: (1/2, -1/2).
TEST_CASE("shear: a disc at rest is struck by an image that its row carries along") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = empty_scene("struck by an image", 20, 1, 8);
        scene.setting.effects.boundaries = {periodic, periodic, sliding, sliding};
        scene.setting.effects.shear = 0.05; // times the height of 20 this is a speed of 1
        scene.setting.sync_every = 4;
        // component of the separation when they touch, after 2 steps
        const double half = std::sqrt(2.0);
        add_disc(scene, 10, 19, 0, 0);
        add_disc(scene, 10 - half - 2, 19 + half - 20, 0, 0);
        DiscSystem system = system_of(scene, method, world);
        advance_to(system, 3);
        CHECK(system.totals().pair_collisions == 1);
        for (const DiscState& disc : system.discs()) {
            CHECK(disc.vx == Approx(disc.id == 0 ? 0.5 : -0.5).epsilon(1e-12));
            CHECK(disc.vy == Approx(disc.id == 0 ? -0.5 : 0.5).epsilon(1e-12));
        }
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Scenes with effects have the bits of the references of both methods, for several windows and
// strips. If an effect's parameters switch it off, they have the bits of the plain dynamics.
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"

#include "dynamics/falling_contact.hpp"
#include "reference_bits.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Gases among obstacles: discs that would overlap an obstacle are left out.
std::vector<TestScene> obstructed_scenes() {
    std::vector<TestScene> scenes;
    for (const TestScene& gas : {gas(300, 0.05, 0.8, 511), gas(196, 0.3, 0.3, 512)}) {
        TestScene scene = empty_scene(gas.name + " among obstacles", gas.setting.box_size,
                                      gas.setting.radius, 14);
        scene.setting.sync_every = 5;
        scene.setting.micro_steps = 2;
        const double size = scene.setting.box_size;
        FixedBodyList& list = scene.setting.effects.fixed_bodies;
        Random random(513);
        for (int k = 0; k < 12; ++k)
            list.discs.push_back({random.uniform(0, size), random.uniform(0, size),
                                  k % 4 == 0 ? 0 : random.uniform(0.2, 3)});
        for (int k = 0; k < 6; ++k) {
            const double x = random.uniform(0.2, 0.8) * size, y = random.uniform(0.2, 0.8) * size;
            list.segments.push_back(
                {x, y, x + random.uniform(-0.2, 0.2) * size, y + random.uniform(-0.2, 0.2) * size});
        }
        list.segments.push_back({0, 0.3 * size, 0.3 * size,
                                 0.25 * size}); // two sides of a funnel; one of them ends at a wall
        list.segments.push_back({0.3 * size, 0.25 * size, 0.3 * size, 0.1 * size});
        scene.discs = gas.discs;
        make_room_for_obstacles(scene);
        scenes.push_back(scene);
    }
    return scenes;
}

} // namespace

TEST_CASE(
    "effects: discs that do not meet, and discs that lose energy, have the references' bits") {
    for (TestScene scene : base_scenes()) {
        ContactEffect& contact = scene.setting.effects.contact;
        for (const auto& [kind, restitution, time] : {std::tuple(ContactKind::none, 1.0, 0.001),
                                                      {ContactKind::restitution, 0.8, 0.001},
                                                      {ContactKind::restitution, 0.05, 0.01},
                                                      {ContactKind::restitution, 0.0, 0.2}}) {
            contact = {kind, restitution, time};
            for (const Method method : {Method::time_stepped, Method::event_driven})
                check_bits(scene, method);
        }
    }
}

// Every pair of contact, sides and gravity occurs in some scene.
TEST_CASE("effects: sides and gravity have the references' bits, alone and together") {
    const Boundary lossy{BoundaryKind::wall, 0.7, 0, 0}, piston{BoundaryKind::moving, 1, 0, -0.03},
        rising{BoundaryKind::moving, 0.9, 0, 0.02};
    const ContactEffect elastic, none{ContactKind::none, 1, 0.001},
        inelastic{ContactKind::restitution, 0.85, 0.002};
    struct Case {
        ContactEffect contact;
        std::array<Boundary, 4> boundaries;
        Acceleration gravity;
    };
    const std::array<Boundary, 4> plain{}, all_lossy{lossy, lossy, lossy, lossy},
        pistons{Boundary{}, piston, rising, piston}, floor{Boundary{}, Boundary{}, lossy, rising};
    const std::vector<Case> cases{
        {elastic, all_lossy, {}},         {elastic, pistons, {}},
        {elastic, plain, {0, -0.05}},     {none, floor, {0.03, 0.04}},
        {inelastic, pistons, {0, -0.03}}, {inelastic, all_lossy, {-0.02, -0.01}}};
    for (TestScene scene : base_scenes()) {
        for (const Case& c : cases) {
            scene.setting.effects = {c.contact, c.boundaries, c.gravity};
            check_bits(scene, Method::event_driven);
        }
        for (const ContactEffect& contact : {elastic, none, inelastic}) {
            scene.setting.effects = {contact, all_lossy, {}};
            check_bits(scene, Method::time_stepped);
        }
    }
}

// Discs among obstacles of both kinds, some of which touch each other or a wall, with other effects
// that change the collisions.
TEST_CASE("effects: obstacles have the references' bits, with restitution, gravity and drag too") {
    for (TestScene scene : obstructed_scenes()) {
        Effects& effects = scene.setting.effects;
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
        effects.fixed_bodies.restitution = 0.7;
        effects.contact = {ContactKind::restitution, 0.9, 0.002};
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
        effects.gravity = {0.01, -0.03};
        scene.setting.falling_contact = falling_contact;
        check_bits(scene, Method::event_driven);
        effects.gravity = {};
        set_drag(scene, 0.2);
        check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("effects: open sides have the references' bits, with obstacles and gravity too") {
    const Boundary open{BoundaryKind::open, 1, 0, 0};
    for (TestScene scene : {base_scenes()[0], base_scenes()[1], obstructed_scenes()[1]}) {
        scene.steps = 24;
        Effects& effects = scene.setting.effects;
        effects.boundaries = {open, Boundary{}, Boundary{}, Boundary{}};
        check_bits(scene, Method::time_stepped);
        effects.boundaries = {open, open, open, open};
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
        effects.boundaries = {Boundary{}, open, open, Boundary{}};
        effects.gravity = {0.02, -0.05};
        scene.setting.falling_contact = falling_contact;
        check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("effects: drag has the reference's bits, with gravity and moving walls too") {
    for (TestScene scene : base_scenes()) {
        Effects& effects = scene.setting.effects;
        set_drag(scene, 0.2);
        check_bits(scene, Method::event_driven);
        effects.gravity = {0.02, -0.05};
        check_bits(scene, Method::event_driven);
        effects.contact = {ContactKind::restitution, 0.9, 0.002};
        effects.boundaries[2].restitution = 0.8;
        check_bits(scene, Method::event_driven);
        effects.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.03};
        effects.boundaries[3] = {BoundaryKind::moving, 0.9, 0, 0.02};
        check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("effects: thermal walls have the references' bits") {
    const Boundary warm{BoundaryKind::thermal, 1, 0.3, 0}, cold{BoundaryKind::thermal, 1, 0.01, 0};
    for (TestScene scene : base_scenes()) {
        scene.steps = 24;
        set_thermal_seed(scene.setting, 77);
        Effects& effects = scene.setting.effects;
        effects.boundaries = {cold, warm, warm, cold};
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
        effects.boundaries = {Boundary{}, Boundary{}, warm,
                              Boundary{BoundaryKind::wall, 0.5, 0, 0}};
        effects.contact = {ContactKind::restitution, 0.9, 0.002};
        check_bits(scene, Method::time_stepped);
        effects.gravity = {0.01, -0.02};
        check_bits(scene, Method::event_driven);
        set_drag(scene, 0.2);
        check_bits(scene, Method::event_driven);
        effects.gravity = {};
        check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("effects: walls that are elastic and at rest, and no gravity, are the plain dynamics to "
          "the bit") {
    const Communicator world = Communicator::world();
    std::vector<TestScene> scenes = base_scenes();
    for (const TestScene& scene : wall_scenes()) {
        if (!scene.cascades_when_event_driven && scene.discs.size() < 100) scenes.push_back(scene);
    }
    for (TestScene& scene : scenes) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            INFO(scene.name);
            scene.setting.effects = {};
            const Totals plain = run(scene, method, world);
            scene.setting.effects.boundaries[1] = {BoundaryKind::moving, 1, 0, 0};
            CHECK(to_string(run(scene, method, world).hash) == to_string(plain.hash));
        }
    }
}

TEST_CASE("effects: a restitution of 1 is the plain dynamics to the bit") {
    const Communicator world = Communicator::world();
    for (TestScene scene : base_scenes()) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            scene.setting.effects = {};
            const Totals plain = run(scene, method, world);
            scene.setting.effects.contact = {ContactKind::restitution, 1, 0.001};
            INFO(scene.name);
            CHECK(to_string(run(scene, method, world).hash) == to_string(plain.hash));
            CHECK(plain.pair_collisions > 0);
        }
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Boxes with periodic sides have the bits of the references of the methods, which search all pairs
// of all images.
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "catch.hpp"
#include <omp.h>

#include "core/state_hash.hpp"
#include "dynamics/falling_contact.hpp"
#include "effect_runs.hpp"
#include "event_driven.hpp"
#include "periodic_bits.hpp"
#include "periodic_scenes.hpp"
#include "scene_tools.hpp"
#include "shape_parts.hpp"
#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("periodic: the time-stepped method has the reference's bits") {
    for (const TestScene& scene : base_scenes())
        for (const auto& boundaries : {both, along_x, along_y})
            check_bits(moved_along(scene, boundaries), Method::time_stepped);
}

TEST_CASE("periodic: beside other effects, the time-stepped method has the reference's bits") {
    for (const TestScene& base : base_scenes()) {
        TestScene scene = moved_along(base, both);
        scene.setting.effects.contact = {ContactKind::restitution, 0.8, 0.001};
        check_bits(scene, Method::time_stepped);
        scene.setting.effects.contact = {ContactKind::none, 1, 0.001};
        check_bits(scene, Method::time_stepped);
        scene = moved_along(base, along_y);
        scene.setting.effects.contact = {ContactKind::restitution, 0.8, 0.001};
        scene.setting.effects.boundaries[1].restitution = 0.7;
        check_bits(scene, Method::time_stepped);
    }
}

TEST_CASE("periodic: beside warm walls, both methods have the reference's bits") {
    for (const TestScene& base : {gas(120, 0.05, 0.8, 801), gas(100, 0.6, 0.3, 802)}) {
        TestScene scene = between_warm_walls(base);
        scene.steps = 24;
        scene.setting.sync_every = 5;
        scene.setting.micro_steps = 2;
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
    }
}

TEST_CASE("periodic: the event-driven method has the reference's bits") {
    for (const TestScene& scene : base_scenes())
        for (const auto& boundaries : {both, along_x, along_y})
            check_bits(moved_along(scene, boundaries), Method::event_driven);
}

TEST_CASE("periodic: beside other effects, the event-driven method has the reference's bits") {
    for (const TestScene& base : base_scenes()) {
        TestScene scene = moved_along(base, both);
        scene.setting.effects.contact = {ContactKind::restitution, 0.8, 0.002};
        check_bits(scene, Method::event_driven);
        scene.setting.effects.contact = {ContactKind::none, 1, 0.001};
        check_bits(scene, Method::event_driven);
        scene = moved_along(base, along_x);
        // Some scenes end as a heap, in which a short contact time would make very many collisions.
        scene.setting.effects.contact = {ContactKind::restitution, 0.9, 0.02};
        scene.setting.effects.boundaries[2].restitution = 0.7;
        scene.setting.effects.boundaries[3] = {BoundaryKind::moving, 1, 0, -0.01};
        scene.setting.effects.gravity = {0, -0.03};
        check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("periodic: among fixed bodies, both methods have the reference's bits") {
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        for (const TestScene& scene : scenes_of_one_disc()) check_bits(scene, method);
        for (const auto& boundaries : {both, along_x, along_y}) {
            for (const TestScene& base : {base_scenes()[0], base_scenes()[1], fast(40)})
                check_bits(among_bodies(base, boundaries), method);
            TestScene scene = among_bodies(base_scenes()[1], boundaries);
            for (const ContactEffect& contact :
                 {ContactEffect{ContactKind::none, 1, 0.001},
                  ContactEffect{ContactKind::restitution, 0.8, 0.002}}) {
                scene.setting.effects.contact = contact;
                check_bits(scene, method);
            }
        }
    }
}

// A disc falls around the box, past images of obstacles in boxes that it was not in at the last
// sync. The obstacles take the energy that gravity gives.
TEST_CASE("periodic: gravity along periodic sides with bodies has the reference's bits") {
    for (const auto& boundaries : {both, along_x, along_y}) {
        for (const TestScene& base : {base_scenes()[0], base_scenes()[1]}) {
            TestScene scene = among_bodies(base, boundaries);
            scene.setting.effects.contact = {ContactKind::restitution, 0.8, 0.002};
            scene.setting.effects.fixed_bodies.restitution = 0.6;
            scene.setting.falling_contact = falling_contact;
            for (const Acceleration& gravity :
                 {Acceleration{0.01, -0.03}, Acceleration{-0.2, 0.3}}) {
                scene.setting.effects.gravity = gravity;
                check_bits(scene, Method::event_driven);
            }
        }
    }
}

TEST_CASE("periodic: mixtures have the references' bits") {
    bool has_more = false;
    for (const TestScene& base : mixtures()) {
        has_more = !has_more;
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            check_bits(base, method);
            TestScene scene = between_walls(base, has_more ? along_x : along_y);
            if (has_more) {
                scene.setting.effects.contact = {ContactKind::restitution, 0.8, 0.002};
                scene.setting.effects.boundaries[2] = {BoundaryKind::thermal, 1, 0.3, 0};
                scene.setting.effects.boundaries[3].restitution = 0.7;
                if (method == Method::event_driven) scene.setting.effects.gravity = {0, -0.03};
                set_thermal_seed(scene.setting, 77);
            }
            check_bits(scene, method);
        }
    }
}

TEST_CASE("periodic: rough discs have the references' bits") {
    std::vector<TestScene> scenes = mixtures();
    for (TestScene& scene : base_scenes()) {
        scene.setting.effects.boundaries = both;
        scene.steps = 8;
        scenes.push_back(scene);
    }
    for (std::size_t k = 0; k < scenes.size(); ++k) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            TestScene scene = scenes[k];
            scene.setting.effects.contact = k % 2 == 0 ? rough(1, 1, 1e300) : rough(0.9, 0.4, 0.3);
            check_bits(scene, method);
            scene = between_walls(scene, k % 2 == 0 ? along_y : along_x);
            if (scene.setting.effects.species.empty()) split_into_species(scene);
            scene.setting.effects.contact = k % 2 == 0 ? rough(0.8, -0.5, 1) : rough(1, 0.7, 0.5);
            check_bits(scene, method);
        }
    }
}

TEST_CASE("periodic: discs of equal species, and smooth ones, are equal discs to the bit") {
    const Communicator world = Communicator::world();
    for (TestScene scene : base_scenes()) {
        scene.setting.effects.boundaries = both;
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            INFO(scene.name << (method == Method::time_stepped ? ", time-stepped"
                                                               : ", event-driven"));
            scene.setting.effects.contact = {};
            scene.setting.effects.species = {};
            const Totals equal = run(scene, method, world);
            const std::uint64_t n = scene.discs.size();
            const double radius = scene.setting.radius;
            scene.setting.effects.species = {{1, radius, 0.3}, {n - 1, radius, 0.3}};
            const Totals mixed = run(scene, method, world);
            CHECK(to_string(mixed.hash) == to_string(equal.hash));
            CHECK(mixed.rejected_candidates == equal.rejected_candidates);
            CHECK(mixed.kinetic_energy == Approx(0.3 * equal.kinetic_energy).epsilon(1e-14));
            scene.setting.effects.contact = rough(1, -1, 0.5);
            DiscSystem smooth = system_of(scene, method, world);
            advance_to(smooth, scene.steps);
            StateHash hash = hash_of(smooth.discs());
            std::array<std::uint64_t, 2> sums{hash.low, hash.high};
            world.sum(sums);
            CHECK(StateHash{sums[0], sums[1]} == equal.hash);
        }
    }
}

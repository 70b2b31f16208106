// SPDX-License-Identifier: BSD-3-Clause
// Boxes with periodic sides have the bits of the plain statements of the methods, which look at all
// pairs of all images.
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "catch.hpp"
#include <omp.h>

#include "core/state_hash.hpp"
#include "effect_runs.hpp"
#include "event_driven.hpp"
#include "periodic_scenes.hpp"
#include "scene_tools.hpp"
#include "shape_parts.hpp"
#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

struct Expected {
    StateHash hash;
    std::uint64_t rejected = 0;
};

Expected expected_of(const TestScene& scene, Method method, const Communicator& world) {
    Expected expected;
    const auto add_states_of = [&expected](const auto& reference) {
        expected.hash = hash_of(reference.discs());
        for (DiscId id = 0; id < reference.spins().size(); ++id)
            expected.hash += hash_of_spin(id, reference.spins()[id]);
    };
    if (world.is_root() && method == Method::time_stepped) {
        reference::TimeSteppedReference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        add_states_of(reference);
        expected.rejected = reference.counters().rejected_candidates;
    } else if (world.is_root()) {
        reference::EventDrivenReference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        add_states_of(reference);
    }
    world.broadcast(expected);
    return expected;
}

void check_bits(const TestScene& scene, Method method) {
    const Communicator world = Communicator::world();
    static std::size_t n_runs = 0;
    if (is_left_to_others(n_runs++, n_sharing(world.size() * omp_get_max_threads()))) return;
    const Expected expected = expected_of(scene, method, world);
    INFO(scene.name << (method == Method::time_stepped ? ", time-stepped" : ", event-driven"));
    for (const std::optional<double>& window : {std::optional<double>{}, {0.3}, {2.7}}) {
        Tuning tuning;
        tuning.window = window;
        tuning.rebalance_above = window ? 0 : 1.05;
        if (window) tuning.cell_width = 0.7;
        const Totals totals = run(scene, method, world, tuning);
        CHECK(to_string(totals.hash) == to_string(expected.hash));
        CHECK(totals.rejected_candidates == expected.rejected);
    }
    Simulation first = simulation_of(scene, method, world);
    advance_to(first, scene.steps / 2);
    Scene again = scene_of(scene);
    again.method = method;
    Simulation second(again,
                      {{first.discs().begin(), first.discs().end()},
                       first.micro_steps_done(),
                       SideColumns(first.side_columns())},
                      world, {});
    advance_to(second, scene.steps);
    CHECK(to_string(second.totals().hash) == to_string(expected.hash));
}

} // namespace

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
        scene = moved_along(
            base,
            along_x); // some end as a heap: a short contact time would make that many collisions
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
            Simulation smooth = simulation_of(scene, method, world);
            advance_to(smooth, scene.steps);
            StateHash hash = hash_of(smooth.discs());
            std::array<std::uint64_t, 2> sums{hash.low, hash.high};
            world.sum(sums);
            CHECK(StateHash{sums[0], sums[1]} == equal.hash);
        }
    }
}

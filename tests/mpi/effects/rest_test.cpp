// SPDX-License-Identifier: BSD-3-Clause
// Discs that come to rest: hits on them against mechanics, the same bits on every machine shape and
// after a restart, what the self-check knows, and the weight of a heap on the floor.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"
#include "engine/wall_event.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double g = 0.01;

std::uint64_t count_resting(const Simulation& simulation, const Communicator& world) {
    std::uint64_t n = 0;
    for (const Disc& disc : simulation.discs()) n += disc.rests() ? 1 : 0;
    return world.sum(n);
}

/// Discs that fall into a box without a lid and lie there in the end.
TestScene heap(ContactKind kind, std::uint64_t seed) {
    TestScene scene = gas(150, 0.3, 0.1, seed);
    scene.setting.sync_every = 4;
    scene.steps = 400;
    Effects& effects = scene.setting.effects;
    effects.contact = {kind, 0.6, 0.2, -0.2, 0.5, 0.5};
    effects.boundaries[2].restitution = 0.6;
    effects.gravity = {0, -g};
    effects.rest = {0.06, 0.02, 0.12};
    return scene;
}

/// A disc lies on the floor, and another one comes along it and hits it after 5 steps with the
/// speed 0.6.
TestScene hit(double wake_speed) {
    TestScene scene = empty_scene("a hit", 40, 1, 6);
    scene.setting.sync_every = 2;
    Effects& effects = scene.setting.effects;
    effects.contact = {ContactKind::restitution, 0.6, 0.1};
    effects.boundaries[2].restitution = 0;
    effects.gravity = {0, -g};
    effects.rest = {0.01, 0.01, wake_speed};
    add_disc(scene, 20, 1);
    add_disc(scene, 15, 1.0001 + 12.5 * g, 0.6, 0);
    return scene;
}

/// What the floor gives to discs of this rank.
struct FloorSum : WallFollower {
    double normal = 0;
    void take(std::span<const WallEvent> events) override {
        for (const WallEvent& event : events)
            if (event.side == 2) normal += event.normal;
    }
};

double vx_of(const Simulation& simulation, DiscId id, const Communicator& world) {
    double vx = -1e9;
    for (const Disc& disc : simulation.shown())
        if (disc.id == id) vx = disc.vx;
    return world.max(vx);
}

} // namespace

TEST_CASE("rest: a hit faster than the waking speed moves a disc, a slower one does not") {
    const Communicator world = Communicator::world();
    for (const double wake_speed : {0.5, 0.7}) {
        const TestScene scene = hit(wake_speed);
        Simulation simulation = simulation_of(scene, Method::event_driven, world);
        advance_to(simulation, 4);
        CHECK(count_resting(simulation, world) == 1);
        advance_to(simulation, scene.steps);
        const bool wakes = wake_speed < 0.6;
        CHECK(count_resting(simulation, world) == (wakes ? 0 : 1));
        CHECK(vx_of(simulation, 0, world) == Approx(wakes ? 0.8 * 0.6 : 0).epsilon(1e-3)); // (1+e)/2
        CHECK(vx_of(simulation, 1, world) == Approx(wakes ? 0.2 * 0.6 : -0.6 * 0.6).epsilon(1e-3));
    }
}

TEST_CASE("rest: heaps have the same bits on all ranks as on one, and pass the check") {
    const Communicator world = Communicator::world();
    for (const ContactKind kind : {ContactKind::restitution, ContactKind::rough}) {
        const TestScene scene = heap(kind, 801);
        check_shared_run(scene, Method::event_driven, world);
        Simulation simulation = simulation_of(scene, Method::event_driven, world);
        advance_to(simulation, scene.steps);
        CHECK(count_resting(simulation, world) > 75);
    }
}

TEST_CASE("rest: heaps have the same bits with other windows and after a restart") {
    const Communicator world = Communicator::world();
    const TestScene heap_scene = heap(ContactKind::rough, 802);
    Scene scene = scene_of(heap_scene);
    scene.method = Method::event_driven;
    Simulation first = simulation_of(heap_scene, Method::event_driven, world);
    Tuning tuning;
    tuning.window = 0.3;
    Simulation windowed = simulation_of(heap_scene, Method::event_driven, world, tuning);
    advance_to(windowed, heap_scene.steps);
    advance_to(first, 301); // between two syncs
    const StoredState state{{first.discs().begin(), first.discs().end()},
                            first.micro_steps_done(),
                            SideColumns(first.side_columns())};
    Simulation second(scene, state, world, {});
    advance_to(first, heap_scene.steps);
    advance_to(second, heap_scene.steps);
    CHECK(second.totals().hash == first.totals().hash);
    CHECK(windowed.totals().hash == first.totals().hash);
}

TEST_CASE("rest: a heap presses the floor with its weight") {
    const Communicator world = Communicator::world();
    for (const ContactKind kind : {ContactKind::restitution, ContactKind::rough}) {
        const TestScene scene = heap(kind, 803);
        Simulation simulation = simulation_of(scene, Method::event_driven, world);
        advance_to(simulation, 800);
        FloorSum floor;
        simulation.follow_walls(floor);
        advance_to(simulation, 1200);
        simulation.forget(floor);
        double normal = 0;
        for (const double part : world.all_gather(floor.normal)) normal += part;
        CHECK(normal == Approx(400 * 150 * g).epsilon(0.01));
    }
}

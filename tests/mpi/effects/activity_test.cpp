// SPDX-License-Identifier: BSD-3-Clause
// Active discs: the same bits on every machine shape, the self-check, and the exact law of free
// discs.
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "catch.hpp"

#include "check/check_failure.hpp"
#include "effect_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Boundary periodic{BoundaryKind::periodic, 1, 0, 0};

/// Scenes of active Brownian discs, of rough discs that tumble, and of two species with one force,
/// rotation and tumbling; each between walls and without walls.
std::vector<TestScene> active_scenes() {
    std::vector<TestScene> scenes;
    for (const bool has_walls : {true, false}) {
        for (const int kind : {0, 1, 2}) {
            TestScene scene = gas(200, 0.2, 0.1, 660 + static_cast<std::uint64_t>(kind));
            scene.name += has_walls ? ", walls, " : ", periodic, ";
            scene.name += std::to_string(kind);
            scene.setting.sync_every = 6;
            scene.setting.micro_steps = 2;
            scene.steps = 40;
            Effects& effects = scene.setting.effects;
            effects.thermostat = {ThermostatKind::langevin, 0, 0.1, 0.02, 7};
            effects.activity = {.speed = 0.2, .rotational_diffusion = 0.05, .seed = 5};
            if (kind == 1) {
                effects.contact = {ContactKind::rough, 0.8, 0.001};
                effects.contact.tangential_restitution = 0.5;
                effects.activity = {.speed = 0.2, .tumble_rate = 0.1, .seed = 5};
            }
            if (kind == 2) {
                effects.species = {{80, 1, 1}, {120, 0.7, 0.4}};
                effects.activity = {
                    .force = 0.02, .rotational_diffusion = 0.05, .tumble_rate = 0.1, .seed = 5};
            }
            if (!has_walls) effects.boundaries.fill(periodic);
            scenes.push_back(scene);
        }
    }
    return scenes;
}

/// Discs that never collide, with a sync in every step.
TestScene free_discs(std::size_t n, const Activity& activity) {
    TestScene scene = gas(n, 0.001, 0, 664);
    scene.setting.effects.boundaries.fill(periodic);
    scene.setting.effects.contact.kind = ContactKind::none;
    scene.setting.effects.thermostat = {ThermostatKind::langevin, 0, 0.3, 0, 7};
    scene.setting.effects.activity = activity;
    scene.setting.micro_steps = scene.setting.sync_every = 4;
    return scene;
}

std::vector<double> directions_of(const DiscSystem& system) {
    std::vector<double> angles(system.discs().size());
    const std::span<const double> own = system.side_columns()[SideColumn::direction];
    for (std::size_t i = 0; i < own.size(); ++i) angles[system.discs()[i].id] = own[i];
    return angles;
}

} // namespace

TEST_CASE("effects: active discs have the same bits on every machine shape, and are checked") {
    const Communicator world = Communicator::world();
    for (const TestScene& scene : active_scenes()) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            INFO(scene.name << ", method " << static_cast<int>(method));
            check_shared_run(scene, method, world);
            CHECK(run_with_restart(scene, method, world).hash == run(scene, method, world).hash);
        }
    }
}

TEST_CASE("effects: a check finds out what discs have not got from their propulsion") {
    const Communicator world = Communicator::world();
    TestScene scene = active_scenes()[0];
    SceneParameters other = scene_of(scene);
    other.method = Method::event_driven;
    other.effects.thermostat = {};
    other.effects.activity = {};
    other.effects.contact.kind = ContactKind::restitution; // the scene must have effects
    DiscSystem system = system_of(scene, Method::event_driven, world);
    system.check_every_step(other);
    CHECK_THROWS_AS(advance_to(system, 30), CheckFailure);
}

TEST_CASE("effects: free active discs come to their speed, along their directions") {
    const Communicator alone = Communicator::of_this_rank();
    for (const bool has_force : {false, true}) {
        TestScene scene = free_discs(50, {.speed = 0.2});
        const double mass = has_force ? 3 : 1;
        if (has_force) {
            scene.setting.effects.activity = {.force = 0.18};
            scene.setting.effects.contact.kind = ContactKind::elastic;
            scene.setting.effects.species = {{50, scene.setting.radius, mass}};
        }
        SceneParameters whole = scene_of(scene);
        whole.method = Method::event_driven;
        DiscSystem system(whole, scene.discs, alone, Tuning{});
        const std::vector<double> first = directions_of(system);
        advance_to(system, 5);
        // Five steps at the rate 0.3; a force of 0.18 gives the same speed, 0.18 / (3 * 0.3) = 0.2.
        const double speed = 0.2 * (1 - std::exp(-1.5)) / 4;
        CHECK(directions_of(system) == first);
        for (const DiscState& disc : system.discs()) {
            CHECK(disc.vx == Approx(speed * std::cos(first[disc.id])).margin(1e-15));
            CHECK(disc.vy == Approx(speed * std::sin(first[disc.id])).margin(1e-15));
        }
    }
}

// The mean cosine of the angle that discs have turned in a time t is exp(-(D + rate) t), and the
// initial directions are uniform. With 20,000 discs the error is some 0.005; the bound is 0.02.
TEST_CASE("effects: directions forget at the sum of both rates") {
    const Communicator alone = Communicator::of_this_rank();
    constexpr std::size_t n = 20'000;
    for (const auto& [diffusion, tumbles] : {std::pair{0.1, 0.0}, {0.0, 0.1}, {0.06, 0.04}}) {
        const TestScene scene = free_discs(
            n, {.speed = 0.2, .rotational_diffusion = diffusion, .tumble_rate = tumbles});
        SceneParameters whole = scene_of(scene);
        whole.method = Method::event_driven;
        DiscSystem system(whole, scene.discs, alone, Tuning{});
        const std::vector<double> first = directions_of(system);
        advance_to(system, 8);
        const std::vector<double> last = directions_of(system);
        double turned = 0, twice = 0, x = 0, y = 0;
        for (std::size_t i = 0; i < n; ++i) {
            CHECK_FALSE(std::fabs(last[i]) > std::numbers::pi);
            turned += std::cos(last[i] - first[i]) / n;
            twice += std::cos(2 * (last[i] - first[i])) / n;
            x += std::cos(first[i]) / n;
            y += std::sin(first[i]) / n;
        }
        INFO("diffusion " << diffusion << ", tumbles " << tumbles);
        CHECK(turned == Approx(std::exp(-0.8)).margin(0.02));
        CHECK(twice == Approx(std::exp(-8 * (4 * diffusion + tumbles))).margin(0.02));
        CHECK(std::hypot(x, y) < 0.03);
    }
}

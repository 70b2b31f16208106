// SPDX-License-Identifier: BSD-3-Clause
// Thermostats: the same bits on every machine shape, conserved quantities, and the self-check.
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "catch.hpp"

#include "check/check_failure.hpp"
#include "core/errors.hpp"
#include "effect_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

std::vector<Thermostat> thermostats() {
    return {{ThermostatKind::kicks, 1e-4, 0, 0, 7},
            {ThermostatKind::andersen, 0, 0.1, 0.02, 7},
            {ThermostatKind::langevin, 0, 0.1, 0.02, 7},
            {ThermostatKind::rescale, 0, 0, 0.02, 7}};
}

constexpr Boundary periodic{BoundaryKind::periodic, 1, 0, 0};
constexpr Boundary sheared{BoundaryKind::sheared, 1, 0, 0};

/// Plain discs, rough ones, and discs of two species, between walls, periodic or sheared sides.
/// They lose energy in collisions.
std::vector<TestScene> driven_scenes() {
    std::vector<TestScene> scenes;
    for (const char* sides : {"walls", "periodic", "sheared"}) {
        for (const int kind : {0, 1, 2}) {
            TestScene scene = gas(200, 0.2, 0.1, 640 + static_cast<std::uint64_t>(kind));
            scene.name += std::string(", ") + sides + ", " + std::to_string(kind);
            scene.setting.sync_every = 6;
            scene.setting.micro_steps = 2;
            scene.steps = 40;
            Effects& effects = scene.setting.effects;
            effects.contact = {ContactKind::restitution, 0.8, 0.001};
            if (kind == 1) {
                effects.contact.kind = ContactKind::rough;
                effects.contact.tangential_restitution = 0.5;
            }
            if (kind == 2) effects.species = {{80, 1, 1}, {120, 0.7, 0.4}};
            if (sides != std::string("walls")) effects.boundaries.fill(periodic);
            if (sides == std::string("sheared")) {
                effects.boundaries[2] = effects.boundaries[3] = sheared;
                effects.shear = 0.004; // this shear over a height of 56 is twice the speed of discs
            }
            scenes.push_back(scene);
        }
    }
    return scenes;
}

double mass_of(const TestScene& scene, DiscId id) {
    for (const Species& one : scene.setting.effects.species) {
        if (id < one.count) return one.mass;
        id -= one.count;
    }
    return 1;
}

} // namespace

TEST_CASE("effects: thermostats give the same bits on every machine shape, and are checked") {
    const Communicator world = Communicator::world();
    for (TestScene scene : driven_scenes()) {
        for (const Thermostat& thermostat : thermostats()) {
            scene.setting.effects.thermostat = thermostat;
            for (const Method method : {Method::time_stepped, Method::event_driven}) {
                INFO(scene.name << ", kind " << static_cast<int>(thermostat.kind) << ", method "
                                << static_cast<int>(method));
                check_shared_run(scene, method, world);
            }
        }
    }
}

TEST_CASE("effects: a check finds out what a thermostat has not given") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(100, 0.2, 0.1, 645);
    scene.setting.sync_every = 6;
    scene.setting.effects.thermostat = thermostats()[1];
    SceneParameters other = scene_of(scene);
    other.method = Method::event_driven;
    other.effects.thermostat = {};
    other.effects.contact.kind = ContactKind::restitution; // the scene must have effects
    DiscSystem system = system_of(scene, Method::event_driven, world);
    system.check_every_step(other);
    CHECK_THROWS_AS(advance_to(system, 30), CheckFailure);
}

TEST_CASE("effects: rescaling fixes the energy, and kicks keep the momentum") {
    const Communicator world = Communicator::world();
    for (TestScene scene : driven_scenes()) {
        if (!scene.setting.effects.are_periodic() || scene.setting.effects.are_sheared()) continue;
        scene.setting.micro_steps = 1;
        scene.setting.sync_every = 5;
        const bool is_rough = scene.setting.effects.contact.kind == ContactKind::rough;
        const double n = 200;
        scene.setting.effects.thermostat = thermostats()[3];
        DiscSystem rescaled = system_of(scene, Method::event_driven, world);
        advance_to(rescaled, 20); // a sync, because 20 is a multiple of 5
        Totals totals = rescaled.totals();
        double mass = 0, momentum_x = 0, momentum_y = 0;
        for (const InputDisc& disc : scene.discs) {
            const double one = mass_of(scene, disc.id);
            mass += one;
            momentum_x += one * disc.vx;
            momentum_y += one * disc.vy;
        }
        const double of_centre = (momentum_x * momentum_x + momentum_y * momentum_y) / (2 * mass);
        CHECK(totals.kinetic_energy + totals.rotational_energy - of_centre ==
              Approx(n * 0.02 * (is_rough ? 1.5 : 1)).epsilon(1e-12));
        scene.setting.effects.thermostat = thermostats()[0];
        DiscSystem kicked = system_of(scene, Method::event_driven, world);
        advance_to(kicked, 20);
        totals = kicked.totals();
        CHECK(totals.momentum_x == Approx(momentum_x).margin(1e-12));
        CHECK(totals.momentum_y == Approx(momentum_y).margin(1e-12));
    }
}

// The rounding error of the discs' mean velocity must not be amplified into heat.
TEST_CASE("effects: discs that all fly alike stay so when velocities are rescaled") {
    const Communicator world = Communicator::world();
    for (const double mass : {0.1, 0.3, 0.37, 7.7}) {
        for (const DiscId n : {DiscId{1}, DiscId{3}}) {
            TestScene scene = empty_scene("a swarm", 40, 1, 20);
            for (DiscId id = 0; id < n; ++id)
                add_disc(scene, 5 + 10 * static_cast<double>(id), 20, 0.3, 0.1);
            scene.setting.sync_every = 2;
            scene.setting.effects.boundaries.fill(periodic);
            scene.setting.effects.species = {{n, 1, mass}};
            scene.setting.effects.thermostat = thermostats()[3];
            DiscSystem system = system_of(scene, Method::event_driven, world);
            advance_to(system, 20);
            INFO("mass " << mass << ", discs " << n);
            CHECK(system.totals().kinetic_energy ==
                  Approx(static_cast<double>(n) * mass * 0.05).epsilon(1e-12));
        }
    }
}

TEST_CASE("effects: discs that become too fast to be counted end the run with a sentence") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = gas(20, 0.01, 0.1, 647);
        scene.setting.sync_every = 2;
        scene.setting.effects.boundaries.fill(periodic);
        scene.setting.effects.thermostat = {ThermostatKind::kicks, 1e14, 0, 0, 7};
        scene.steps = 10;
        std::string text;
        try {
            run(scene, method, world);
        } catch (const CollectiveError& error) {
            text = error.what();
        }
        INFO(text);
        CHECK(text.find("at step 2 the fastest disc flies") != std::string::npos);
    }
}

// Without collisions discs are independent, so the mean squares after a time t are known.
TEST_CASE(
    "effects: free discs between kicks, new velocities and Ornstein and Uhlenbeck's process") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(4000, 0.2, 0.1, 646);
    scene.setting.sync_every = 4;
    scene.setting.effects.boundaries.fill(periodic);
    scene.setting.effects.contact.kind = ContactKind::none;
    const double n = 4000, start = [&] {
        double sum = 0;
        for (const InputDisc& disc : scene.discs) sum += disc.vx * disc.vx + disc.vy * disc.vy;
        return sum / (2 * n);
    }();
    const double time = 20, noise = 4 / std::sqrt(n); // four standard errors of a mean square
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        const auto mean_square = [&](const Thermostat& thermostat) {
            scene.setting.effects.thermostat = thermostat;
            DiscSystem system = system_of(scene, method, world);
            advance_to(system, static_cast<std::int64_t>(time));
            return system.totals().kinetic_energy / n;
        };
        const double strength = 1e-4, rate = 0.05, kt = 0.02;
        CHECK(mean_square({ThermostatKind::kicks, strength, 0, 0, 9}) ==
              Approx(start + strength * time).epsilon(noise));
        const double left = std::exp(-rate * time);
        CHECK(mean_square({ThermostatKind::andersen, 0, rate, kt, 9}) ==
              Approx(start * left + kt * (1 - left)).epsilon(noise));
        CHECK(mean_square({ThermostatKind::langevin, 0, rate, kt, 9}) ==
              Approx(start * left * left + kt * (1 - left * left)).epsilon(noise));
    }
}

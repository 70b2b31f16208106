// SPDX-License-Identifier: BSD-3-Clause
// The numbers of effects in micro-steps compared with formulas, and energies of discs compared with
// mechanics.
#include <cmath>

#include "catch.hpp"

#include "scene/effects/effect.hpp"
#include "scene/key.hpp"

using namespace carrom;

TEST_CASE("a unit says how a number scales") {
    CHECK(dimension_of("length") == Dimension{1, 0, 0});
    CHECK(dimension_of("steps") == Dimension{0, 1, 0});
    CHECK(dimension_of("1/step") == Dimension{0, -1, 0});
    CHECK(dimension_of("length/step^2") == Dimension{1, -2, 0});
    CHECK(dimension_of("mass length^2/step^2") == Dimension{2, -2, 1});
    CHECK(dimension_of("length^2/step^3") == Dimension{2, -3, 0});
    CHECK(dimension_of("step/length") == Dimension{-1, 1, 0});
    CHECK(dimension_of("") == Dimension{});
    CHECK(dimension_of("1") == Dimension{});
    CHECK(dimension_of("radians") == Dimension{});
    CHECK(dimension_of("micro-steps") == Dimension{});
}

TEST_CASE("effects in micro-steps are those of steps in another unit of time") {
    SceneParameters scene;
    scene.micro_steps = 5;
    Effects& e = scene.effects;
    e.contact = {ContactKind::rough, 0.9, 0.25, 0.3, 0.5, 0.4};
    for (Boundary& side : e.boundaries)
        side = {BoundaryKind::thermal, 0.8, 3, 0.7, 0.1, 11, 0.6, {0.2, 0.3, 0.9}};
    e.gravity = {0.01, -0.02, 0.03, 0.04, 7, 0.1, 0.2};
    e.drag = 0.03;
    e.growth = 0.04;
    e.shear = 0.05;
    e.lasting_speed = 0.06;
    e.fixed_bodies.discs = {{1, 2, 3}};
    e.fixed_bodies.surface = {0.4, 0.5, 0.7};
    e.fixed_bodies.restitution = 0.6;
    e.species = {{3, 0.5, 2}};
    e.thermostat = {ThermostatKind::langevin, 0.07, 0.08, 0.09, 11};
    e.activity = {0.1, 0.2, 0.3, 0.4, 13};
    e.thermal_seed = 17;
    e.field.stiffness_x = 0.6;
    e.field.centre_x = 3;
    e.field.amplitude = 0.7;

    Effects expected = e;
    expected.contact.contact_time = 0.25 * 5;
    for (Boundary& side : expected.boundaries) {
        side.temperature = 3.0 / 25;
        side.speed = 0.7 / 5;
        side.period = 11 * 5;
        side.surface.velocity = 0.9 / 5;
    }
    expected.gravity = {0.01 / 25, -0.02 / 25, 0.03 / 25, 0.04 / 25, 7 * 5, 0.1, 0.2};
    expected.field.stiffness_x = 0.6 / 25;
    expected.field.amplitude = 0.7 / 25;
    expected.drag = 0.03 / 5;
    expected.growth = 0.04 / 5;
    expected.shear = 0.05 / 5;
    expected.lasting_speed = 0.06 / 5;
    expected.fixed_bodies.surface.velocity = 0.7 / 5;
    expected.thermostat.strength = 0.07 / 125;
    expected.thermostat.rate = 0.08 / 5;
    expected.thermostat.temperature = 0.09 / 25;
    expected.activity = {0.1 / 5, 0.2 / 25, 0.3 / 5, 0.4 / 5, 13};
    CHECK(per_micro_step(scene) == expected);
    scene.micro_steps = 1;
    CHECK(per_micro_step(scene) == e);
}

TEST_CASE("effects know the energy of a disc") {
    Effects effects;
    CHECK(other_energies_of(effects).empty());
    const Box box(30, 20);
    const ShownDisc disc{4, 7, 0.1, 0.2, 0.5, {1.5, 3}};
    const auto energy = [&] {
        double sum = 0;
        for (const OtherEnergy& one : other_energies_of(effects))
            sum += one.of_disc(disc, effects, box);
        return sum;
    };
    effects.gravity = {0, -0.25}; // downwards: m g h above the bottom
    CHECK(energy() == Approx(3 * 0.25 * 7).epsilon(1e-15));
    effects.gravity = {0.5, 0}; // gravity to the right: the height is counted from the right side
    CHECK(energy() == Approx(3 * 0.5 * (30 - 4)).epsilon(1e-15));
    effects.gravity = {};
    effects.contact.kind = ContactKind::rough;
    effects.contact.inertia = 0.4; // in units of m r^2
    CHECK(energy() == Approx(0.5 * 0.4 * 3 * 1.5 * 1.5 * 0.5 * 0.5).epsilon(1e-15));
    // The effect of drag and growth on energies.
    effects.drag = 0.1;
    CHECK(energy_left_by(effects, 7) == Approx(std::exp(-1.4)).epsilon(1e-15));
    effects.gravity = {0, 1}; // with gravity the loss by drag depends on the flight
    CHECK(energy_left_by(effects, 7) == 1);
    effects.growth = 0.01;
    CHECK(work_in_collision(effects, 2, 3) == Approx(2 * 0.01 * 3).epsilon(1e-15));
    CHECK(work_on_way(effects, {1, 2, {1, 1}}) == 0);
}

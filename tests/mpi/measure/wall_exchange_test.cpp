// SPDX-License-Identifier: BSD-3-Clause
// Energy and momentum from walls, compared with the balance of all discs, which gain both only from
// walls and gravity. Also in runs with a restart between samples.
#include <array>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "measure/wall_sums.hpp"
#include "measured_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double pull = 0.002;

struct Balance {
    double energy = 0, x = 0, y = 0;
};

Balance balance_of(const std::vector<SeenDisc>& discs, double gravity) {
    Balance sum;
    for (const SeenDisc& disc : discs) {
        const double mass = disc.id < 100 ? 1 : 4;
        sum.energy += mass * ((disc.vx * disc.vx + disc.vy * disc.vy) / 2 + gravity * disc.y);
        sum.x += mass * disc.vx;
        sum.y += mass * disc.vy;
    }
    return sum;
}

/// Walls that heat, cool, take energy and move in.
TestScene between_walls(double gravity) {
    TestScene test = gas(300, 0.2, 0.5, 91);
    Effects& effects = test.setting.effects;
    effects.species = {{100, test.setting.radius, 1}, {200, test.setting.radius, 4}};
    effects.boundaries[0] = {BoundaryKind::thermal, 1, 0.8, 0};
    effects.boundaries[1] = {BoundaryKind::thermal, 1, 0.1, 0};
    effects.boundaries[2].restitution = 0.8;
    if (gravity == 0) effects.boundaries[3] = {BoundaryKind::moving, 1, 0, -0.02};
    effects.gravity.y = -gravity;
    test.setting.sync_every = 16;
    test.steps = 60;
    return test;
}

SceneParameters with_exchange(const TestScene& test, Method method) {
    SceneParameters scene = measured(test, method, 5);
    scene.measurements->quantities = {"wall_exchange", "wall_pressure"};
    return scene;
}

} // namespace

TEST_CASE("measurements: walls give what the discs gain") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        for (const double gravity : {0.0, pull}) {
            const TestScene test = between_walls(gravity);
            const SceneParameters scene = with_exchange(test, method);
            DiscSystem system = system_of(scene, test, world);
            Sampler sampler(scene, system, world);
            advance_to(system, sampler, 0);
            std::vector<Balance> seen = {balance_of(seen_discs(system, world), gravity)};
            for (int sample = 1; sample <= 12; ++sample) {
                advance_to(system, sampler, 5 * sample);
                seen.push_back(balance_of(seen_discs(system, world), gravity));
            }
            const std::vector<MeasuredTable> tables = sampler.tables();
            const std::vector<std::vector<double>>
                given = table_of(tables, "wall_exchange_history").rows,
                pressures = table_of(tables, "wall_pressure_history").rows;
            REQUIRE(given.size() == 12);
            double exchanged = 0;
            for (std::size_t k = 0; k < given.size(); ++k) {
                std::array<double, 4> heat{}, shear{}, normal{};
                for (std::size_t side = 0; side < 4; ++side) {
                    const double per = 5 * length_of_side(scene, side,
                                                          5 * static_cast<double>(k) + 2.5);
                    heat[side] = given[k][2 + side] * per;
                    shear[side] = given[k][6 + side] * per;
                    normal[side] = pressures[k][2 + side] * per;
                    exchanged += std::fabs(heat[side]);
                }
                INFO("interval " << k << ", gravity " << gravity);
                const Balance before = seen[k], after = seen[k + 1];
                // The time-stepped method stops discs at walls at the end of a micro-step, which
                // changes their height, and so their potential energy.
                const bool keeps_heights = gravity == 0 || method == Method::event_driven;
                CHECK(heat[0] + heat[1] + heat[2] + heat[3] ==
                      Approx(after.energy - before.energy).margin(keeps_heights ? 1e-9 : 0.05));
                CHECK(normal[0] - normal[1] + shear[2] + shear[3] ==
                      Approx(after.x - before.x).margin(1e-9));
                CHECK(normal[2] - normal[3] + shear[0] + shear[1] ==
                      Approx(after.y - before.y + gravity * 5 * 900).margin(1e-9));
                CHECK(heat[2] <= 0); // this wall takes energy
            }
            CHECK(exchanged > 10);
        }
    }
}

TEST_CASE("measurements: the exchange with walls goes on between samples") {
    const Communicator world = Communicator::world();
    const TestScene test = between_walls(pull);
    const SceneParameters scene = with_exchange(test, Method::event_driven);
    DiscSystem whole = system_of(scene, test, world);
    Sampler whole_sampler(scene, whole, world);
    advance_to(whole, whole_sampler, 60);
    DiscSystem first = system_of(scene, test, world);
    Sampler first_sampler(scene, first, world);
    advance_to(first, first_sampler, 33);
    StoredState state{{first.discs().begin(), first.discs().end()}, first.micro_steps_done()};
    DiscSystem second(scene, std::move(state), world, {});
    Sampler sampler(scene, second, world);
    sampler.go_on(first_sampler.stored());
    advance_to(second, sampler, 60);
    const std::vector<MeasuredTable> expected = whole_sampler.tables(), tables = sampler.tables();
    for (const char* name : {"wall_exchange_history", "wall_pressure_history"})
        CHECK(table_of(tables, name).rows == table_of(expected, name).rows);
}

// SPDX-License-Identifier: BSD-3-Clause
// The table of the usual quantities over time, compared with totals of the run and sums over all
// discs.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

struct Case {
    const char* name;
    Method method;
    Effects effects;
};

std::vector<Case> cases() {
    Effects none, around, falling, rough;
    around.boundaries.fill({BoundaryKind::periodic, 1, 0, 0});
    falling.gravity = {0.001, -0.003};
    rough.contact = {ContactKind::rough, 0.9, 0.001, 1, 0.8, 0.5};
    rough.species = {{100, 1, 2}, {100, 0.7, 1}};
    return {{"time-stepped", Method::time_stepped, none},
            {"periodic", Method::event_driven, around},
            {"gravity", Method::event_driven, falling},
            {"rough discs of two species", Method::event_driven, rough}};
}

TestScene test_of(const Case& each) {
    TestScene test = gas(200, 0.2, 0.5, 77);
    test.setting.effects = each.effects;
    test.setting.micro_steps = 2;
    test.setting.sync_every = 24;
    test.steps = 60;
    return test;
}

SceneParameters with_thermo(const TestScene& test, const Case& each) {
    SceneParameters scene = measured(test, each.method, 9, 5);
    MeasurementOutput& output = *scene.measurements;
    output.quantities = {"pressure", "thermo"};
    return scene;
}

} // namespace

TEST_CASE("measurements: thermo has the run's energy, collisions and pressure at each sample") {
    const Communicator world = Communicator::world();
    for (const Case& each : cases()) {
        INFO(each.name);
        const TestScene test = test_of(each);
        const SceneParameters scene = with_thermo(test, each);
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        std::vector<double> energies, pairs;
        for (std::int64_t step = 5; step <= 60; step += 9) {
            advance_to(system, sampler, step);
            const Totals totals = system.totals();
            energies.push_back(totals.kinetic_energy + totals.rotational_energy +
                               totals.potential_energy);
            pairs.push_back(static_cast<double>(totals.pair_collisions));
            const std::size_t n_rows = energies.size();
            REQUIRE(sampler.rows_from(n_rows - 1).size() == 1);
            CHECK(sampler.rows_from(n_rows - 1).front().rows.size() == 1);
            CHECK(sampler.rows_from(n_rows).empty());
        }
        const std::vector<MeasuredTable> tables = sampler.tables();
        CHECK(column_of(tables, "thermo", "energy") == energies);
        CHECK(column_of(tables, "thermo", "step")[2] == 23);
        const std::vector<double> rates = column_of(tables, "thermo", "collision_rate");
        CHECK(pairs.back() > pairs.front());
        for (std::size_t k = 1; k < pairs.size(); ++k)
            CHECK(rates[k] == Approx(2 * (pairs[k] - pairs[k - 1]) / (200 * 9)).epsilon(1e-14));
        for (const char* part : {"xx", "xy", "yy"}) {
            std::vector<double> after_first = column_of(tables, "thermo", part);
            CHECK(std::isnan(after_first[0]));
            after_first.erase(after_first.begin());
            CHECK(after_first == column_of(tables, "pressure_history", part));
        }
        // kT of an interval is an integral over time (compared with samples of every step in
        // simulation/sync_every_test.cpp). It lies roughly between the values at both ends, and
        // equals them if kT is conserved.
        const std::vector<double> kt = column_of(tables, "thermo", "temperature"),
                                  means = column_of(tables, "pressure_history", "temperature");
        for (std::size_t k = 0; k < means.size(); ++k) {
            const auto [least, most] = std::minmax(kt[k], kt[k + 1]);
            const double share = each.effects.are_any() ? 0.02 : 1e-12;
            CHECK(means[k] >= least * (1 - share));
            CHECK(means[k] <= most * (1 + share));
        }
    }
}

TEST_CASE("measurements: thermo goes on from what was stored, to the same rows") {
    const Communicator world = Communicator::world();
    for (const Case& each : cases()) {
        // a restart of rough discs would also need their spins
        if (each.effects.contact.kind == ContactKind::rough) continue;
        INFO(each.name);
        const TestScene test = test_of(each);
        SceneParameters scene = with_thermo(test, each);
        leave_out(scene, "pressure");
        check_going_on(scene, test, 33, 60, world);
    }
}

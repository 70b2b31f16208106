// SPDX-License-Identifier: BSD-3-Clause
// Transport coefficients, compared with Helfand's moments of discs that have not reached the sides
// of the box; also in runs with a restart between samples.
#include <array>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// A dense square of discs in the middle of a periodic box. They collide with each other, and none
/// reaches a side during the test.
TestScene cluster() {
    TestScene test = gas(400, 0.2, 0.1, 29);
    const double shift = test.setting.box_size;
    test.setting.box_size *= 3;
    for (InputDisc& disc : test.discs) disc.x += shift, disc.y += shift;
    for (Boundary& side : test.setting.effects.boundaries) side.kind = BoundaryKind::periodic;
    test.setting.sync_every = 16;
    test.steps = 100;
    return test;
}

SceneParameters with_transport(const TestScene& test, Method method) {
    SceneParameters scene = measured(test, method, 5);
    scene.measurements->quantities = {"transport"};
    scene.measurements->give("correlation_points", 4);
    return scene;
}

/// The moments of stress xy and (xx - yy) / 2, and of heat along x and y, relative to the centre of
/// mass.
using Moments = std::array<double, 4>;

Moments moments_of(const std::vector<SeenDisc>& discs) {
    const double n = static_cast<double>(discs.size());
    double ux = 0, uy = 0;
    for (const SeenDisc& disc : discs) ux += disc.vx / n, uy += disc.vy / n;
    Moments moments{};
    for (const SeenDisc& disc : discs) {
        const double vx = disc.vx - ux, vy = disc.vy - uy, energy = (vx * vx + vy * vy) / 2;
        moments[0] += disc.vx * disc.y; // the stress includes the momentum flux of the drift
        moments[1] += (disc.vx * disc.x - disc.vy * disc.y) / 2;
        moments[2] += energy * (disc.x);
        moments[3] += energy * (disc.y);
    }
    return moments;
}

} // namespace

TEST_CASE("measurements: transport is the spread of Helfand's moments") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        const TestScene test = cluster();
        const SceneParameters scene = with_transport(test, method);
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        std::vector<Moments> moments;
        double ux = 0, uy = 0, kinetic = 0;
        for (int sample = 0; sample <= 20; ++sample) {
            advance_to(system, sampler, 5 * sample);
            moments.push_back(moments_of(seen_discs(system, world)));
        }
        REQUIRE(system.totals().pair_collisions > 200);
        const std::vector<SeenDisc> last = seen_discs(system, world);
        const double n = static_cast<double>(last.size()), area = scene.box.area();
        for (const SeenDisc& disc : last) {
            ux += disc.vx / n, uy += disc.vy / n;
            kinetic += disc.vx * disc.vx + disc.vy * disc.vy;
        }
        const double kT = (kinetic - n * (ux * ux + uy * uy)) / (2 * (n - 1));
        // In the frame of the centre of mass, the positions in the moments of energy move with
        // the drift velocity.
        for (std::size_t t = 0; t < moments.size(); ++t) {
            const double energy = kT * (n - 1);
            moments[t][2] -= ux * energy * 5 * static_cast<double>(t);
            moments[t][3] -= uy * energy * 5 * static_cast<double>(t);
        }
        const std::vector<MeasuredTable> tables = sampler.tables();
        const MeasuredTable& table = table_of(tables, "transport");
        REQUIRE(table.rows.size() == 8); // lags of 1 2 3 4 6 8 12 16
        for (const std::vector<double>& row : table.rows) {
            const auto lag = static_cast<std::size_t>(row[0]) / 5;
            std::size_t spacing = 1;
            while (4 * spacing < lag) spacing *= 2;
            double shear = 0, heat = 0, count = 0;
            for (std::size_t t = 0; t + lag < moments.size(); t += spacing, ++count) {
                Moments d;
                for (std::size_t k = 0; k < 4; ++k) d[k] = moments[t + lag][k] - moments[t][k];
                shear += (d[0] * d[0] + d[1] * d[1]) / 2;
                heat += (d[2] * d[2] + d[3] * d[3]) / 2;
            }
            INFO(lag);
            CHECK(row[1] == count);
            CHECK(row[2] == Approx(shear / count / (2 * area * kT * row[0])).epsilon(1e-8));
            CHECK(row[6] == Approx(heat / count / (2 * area * kT * kT * row[0])).epsilon(1e-8));
        }
    }
}

TEST_CASE("measurements: transport goes on between samples") {
    const Communicator world = Communicator::world();
    const TestScene test = cluster();
    const SceneParameters scene = with_transport(test, Method::event_driven);
    check_going_on(scene, test, 53, 100, world);
}

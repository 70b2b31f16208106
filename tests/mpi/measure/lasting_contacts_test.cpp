// SPDX-License-Identifier: BSD-3-Clause
// Heaps at rest compared with statics: the weight on the floor, and the forces across each height,
// at two rates of syncs. Also the same bits on every machine shape.
#include <algorithm>
#include <string>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double g = 0.01, width = 24;
constexpr std::int64_t at_rest = 320, end = 350;
constexpr double n_rows = 8, row_height = width / n_rows;

/// Discs of two sizes and masses that fall to the floor of a box with smooth walls, which bear no
/// weight.
TestScene heap(std::int64_t sync_every) {
    TestScene scene = empty_scene("a heap", width, 1, end);
    Random random(641);
    for (int k = 0; k < 80; ++k)
        add_disc(scene, 1.5 + 2.3 * (k % 10) + random.uniform(-0.1, 0.1),
                 1.5 + 2.3 * static_cast<double>(k / 10) + random.uniform(-0.1, 0.1));
    random.shuffle(scene.discs); // mixes the species
    for (std::size_t k = 0; k < scene.discs.size(); ++k) scene.discs[k].id = k;
    scene.setting.sync_every = sync_every;
    Effects& effects = scene.setting.effects;
    effects.species = {{40, 1, 1}, {40, 0.8, 2}};
    effects.contact = {ContactKind::rough, 0.5, 0.01, 0, 0.5, 0.5};
    effects.boundaries[2].restitution = 0.5;
    effects.boundaries[2].surface = {0, 0.5, 0};
    effects.gravity.y = -g;
    effects.lasting_speed = 0.05;
    return scene;
}

double mass_of(const SeenDisc& disc) { return disc.id < 40 ? 1 : 2; }

SceneParameters measured_heap(const TestScene& test) {
    SceneParameters scene = measured(test, Method::event_driven, 5, at_rest);
    scene.measurements->quantities = {"wall_pressure", "wall_exchange", "profiles"};
    scene.measurements->give("profile_columns", 1);
    scene.measurements->give("profile_rows", n_rows);
    scene.measurements->give("profile_samples", 7);
    return scene;
}

/// The weight above the lines in a row of cells per length, averaged over the row.
double pressure_in_row(const std::vector<SeenDisc>& discs, double low) {
    double sum = 0;
    for (const SeenDisc& disc : discs)
        sum += mass_of(disc) * g * std::clamp(disc.y - low, 0.0, row_height);
    return sum / (width * row_height);
}

} // namespace

TEST_CASE("measurements: a heap at rest presses the floor and itself as statics says") {
    const Communicator world = Communicator::world();
    for (const std::int64_t sync_every : {1, 2}) {
        INFO("a sync every " << sync_every << " steps");
        const TestScene test = heap(sync_every);
        const SceneParameters scene = measured_heap(test);
        DiscSystem shared = system_of(scene, test, world);
        shared.check_every_step(scene);
        Sampler sampler(scene, shared, world);
        CHECK_NOTHROW(advance_to(shared, sampler, end));
        DiscSystem single(scene, test.discs, Communicator::of_this_rank(), Tuning{});
        carrom::advance_to(single, end);
        CHECK(shared.totals().hash == single.totals().hash);

        const std::vector<MeasuredTable> tables = sampler.tables();
        const std::vector<double> walls = table_of(tables, "wall_pressure").rows.front(),
                                  exchange = table_of(tables, "wall_exchange").rows.front();
        CHECK(walls[2] * width == Approx(40 * g + 40 * 2 * g).epsilon(0.01));
        CHECK(walls[10] == 0);                        // discs at rest do not collide
        CHECK(exchange[4] == Approx(0).margin(1e-6)); // and they get no energy
        const std::vector<SeenDisc> discs = seen_discs(shared, world);
        const MeasuredTable& profiles = table_of(tables, "profiles");
        REQUIRE(profiles.rows.size() == 8);
        const auto column = [&profiles](const std::string& name) {
            const auto found = std::find(profiles.columns.begin(), profiles.columns.end(), name);
            return static_cast<std::size_t>(found - profiles.columns.begin());
        };
        for (std::size_t row = 1; row < 4; ++row) { // the lowest row lacks the floor's forces
            const double expected = pressure_in_row(discs, static_cast<double>(row) * row_height);
            INFO("row " << row << ", expected " << expected);
            CHECK(profiles.rows[row][column("vy")] == Approx(0).margin(1e-6));
            CHECK(profiles.rows[row][column("contact_yy")] == Approx(expected).epsilon(0.02));
            CHECK(profiles.rows[row][column("contact_heat_y")] == Approx(0).margin(1e-6));
        }
    }
}

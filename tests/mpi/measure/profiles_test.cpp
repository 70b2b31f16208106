// SPDX-License-Identifier: BSD-3-Clause
// Profiles on a grid, against sums over all discs of each cell; a restart inside a block.
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr std::size_t n_x = 5, n_y = 3;

struct Seen {
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;
};

std::vector<Seen> all_of(const Simulation& simulation, const Communicator& world) {
    std::vector<Seen> mine;
    const double unit = simulation.velocity_unit(), time = simulation.clock();
    for (const Disc& disc : simulation.shown())
        mine.push_back({disc.id, disc.x_at(time), disc.y_at(time), disc.vx * unit, disc.vy * unit});
    std::vector<std::vector<Seen>> out(static_cast<std::size_t>(world.size()), mine);
    return send_to_owners(world, out).items;
}

/// All discs of a cell, over the samples of a block.
struct Cell {
    std::vector<Seen> discs;
    std::vector<double> masses;
};

/// Two passes: first the velocity of the centre of mass, then squares about it.
std::vector<double> row_of(const Cell& cell, double area, double n_samples) {
    double mass = 0, vx = 0, vy = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t k = 0; k < cell.discs.size(); ++k) {
        mass += cell.masses[k];
        vx += cell.masses[k] * cell.discs[k].vx;
        vy += cell.masses[k] * cell.discs[k].vy;
    }
    vx /= mass, vy /= mass;
    for (std::size_t k = 0; k < cell.discs.size(); ++k) {
        const double a = cell.discs[k].vx - vx, b = cell.discs[k].vy - vy, m = cell.masses[k];
        xx += m * a * a, xy += m * a * b, yy += m * b * b;
    }
    const double n = static_cast<double>(cell.discs.size()), per_area = 1 / (area * n_samples);
    return {n,           n * per_area,  vx,           vy, (xx + yy) / (2 * n),
            xx * per_area, xy * per_area, yy * per_area};
}

Scene with_profiles(const TestScene& test, Method method) {
    Scene scene = measured(test, method, 5, 3);
    scene.measurements->quantities = {"profiles"};
    scene.measurements->give("profile_columns", n_x);
    scene.measurements->give("profile_rows", n_y);
    scene.measurements->give("profile_samples", 3);
    return scene;
}

TestScene mixture() {
    TestScene test = gas(300, 0.2, 0.5, 91);
    test.setting.effects.species = {{100, test.setting.radius, 1}, {200, test.setting.radius, 4}};
    test.setting.sync_every = 16;
    test.steps = 40;
    return test;
}

} // namespace

TEST_CASE("measurements: profiles are what the discs of each cell give") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        const TestScene test = mixture();
        const Scene scene = with_profiles(test, method);
        Simulation simulation = simulation_of(scene, test, world);
        Sampler sampler(scene, simulation, world);
        std::vector<std::vector<double>> expected;
        std::vector<Cell> cells(n_x * n_y);
        std::size_t n_samples = 0;
        for (std::int64_t step = 0; step <= 40; ++step) {
            advance_to(simulation, sampler, step);
            if (step < 3 || (step - 3) % 5 != 0) continue;
            for (const Seen& disc : all_of(simulation, world)) {
                const auto column = static_cast<std::size_t>(disc.x / scene.box.x * n_x),
                           row = static_cast<std::size_t>(disc.y / scene.box.y * n_y);
                cells[row * n_x + column].discs.push_back(disc);
                cells[row * n_x + column].masses.push_back(disc.id < 100 ? 1 : 4);
            }
            if (++n_samples % 3 != 0) continue;
            for (const Cell& cell : cells)
                expected.push_back(row_of(cell, scene.box.area() / (n_x * n_y), 3));
            cells.assign(n_x * n_y, {});
        }
        const std::vector<MeasuredTable> tables = sampler.tables();
        const MeasuredTable& table = table_of(tables, "profiles");
        REQUIRE(table.rows.size() == expected.size());
        REQUIRE(table.rows.size() == 2 * n_x * n_y); // eight samples are two whole blocks
        double total = 0;
        for (std::size_t k = 0; k < expected.size(); ++k) {
            total += table.rows[k][3];
            CHECK(table.rows[k][0] == (k < n_x * n_y ? 13 : 28));
            for (std::size_t column = 0; column < expected[k].size(); ++column)
                CHECK(table.rows[k][3 + column] ==
                      Approx(expected[k][column]).epsilon(1e-11).margin(1e-13));
        }
        CHECK(total == 2 * 3 * 300);
    }
}

TEST_CASE("measurements: profiles go on inside a block") {
    const Communicator world = Communicator::world();
    const TestScene test = mixture();
    const Scene scene = with_profiles(test, Method::event_driven);
    Simulation whole = simulation_of(scene, test, world);
    Sampler whole_sampler(scene, whole, world);
    advance_to(whole, whole_sampler, 40);
    Simulation first = simulation_of(scene, test, world);
    Sampler first_sampler(scene, first, world);
    advance_to(first, first_sampler, 21); // one sample of the second block has been taken
    StoredState state{{first.discs().begin(), first.discs().end()}, first.micro_steps_done()};
    Tuning tuning;
    Simulation second(scene, std::move(state), world, tuning);
    Sampler sampler(scene, second, world);
    sampler.go_on(first_sampler.stored());
    advance_to(second, sampler, 40);
    CHECK(table_of(sampler.tables(), "profiles").rows ==
          table_of(whole_sampler.tables(), "profiles").rows);
}

// SPDX-License-Identifier: BSD-3-Clause
// Every count and sum of the tables, compared with values computed from all discs, pair by pair;
// also in runs with a restart.
#include <array>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "core/errors.hpp"
#include "measured_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

struct Seen {
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;
};

/// All discs on every rank, by ascending id.
std::vector<Seen> all_of(const DiscSystem& system, const Communicator& world) {
    std::vector<Seen> mine;
    const double unit = system.velocity_unit(), time = system.clock();
    for (const DiscState& disc : system.shown())
        mine.push_back({disc.id, disc.x_at(time), disc.y_at(time), disc.vx * unit, disc.vy * unit});
    std::vector<std::vector<Seen>> out(static_cast<std::size_t>(world.size()), mine);
    std::vector<Seen> all = send_to_owners(world, out).items;
    std::sort(all.begin(), all.end(), [](const Seen& a, const Seen& b) { return a.id < b.id; });
    return all;
}

/// The expected tables, computed in the simplest way.
struct ByHand {
    std::vector<double> pairs = std::vector<double>(20, 0), vx = pairs, vy = pairs, speeds = pairs,
                        x = pairs, y = pairs, displacement;
    std::vector<Seen> first;

    static void count(std::vector<double>& bins, double value, double low, double high) {
        for (std::size_t k = 0; k < bins.size(); ++k) {
            const double n = static_cast<double>(bins.size());
            const double from = low + (high - low) * static_cast<double>(k) / n,
                         to = low + (high - low) * static_cast<double>(k + 1) / n;
            if (value >= from && value < to) bins[k] += 1;
        }
    }

    void add(const std::vector<Seen>& discs, const Extent& box, double largest_distance,
             double largest_velocity) {
        if (first.empty()) first = discs;
        double sum = 0;
        for (std::size_t i = 0; i < discs.size(); ++i) {
            const Seen& p = discs[i];
            count(vx, p.vx, -largest_velocity, largest_velocity);
            count(vy, p.vy, -largest_velocity, largest_velocity);
            count(speeds, std::hypot(p.vx, p.vy), 0, largest_velocity);
            count(x, p.x, box.x_low, box.x_high);
            count(y, p.y, box.y_low, box.y_high);
            for (std::size_t j = 0; j < i; ++j)
                count(pairs, std::hypot(p.x - discs[j].x, p.y - discs[j].y), 0, largest_distance);
            sum += (p.x - first[i].x) * (p.x - first[i].x) +
                   (p.y - first[i].y) * (p.y - first[i].y);
        }
        displacement.push_back(sum / static_cast<double>(discs.size()));
    }
};

struct Case {
    const char* name;
    Method method;
    Effects effects;
};

std::vector<Case> cases() {
    Effects none, falling, slowed, sinking, piston;
    falling.gravity = {0.001, -0.003};
    falling.boundaries[2] = {BoundaryKind::thermal, 1, 0.2, 0};
    slowed.drag = 0.02;
    slowed.contact.kind = ContactKind::restitution;
    slowed.contact.restitution = 0.9;
    sinking.gravity = {0.001, -0.003};
    sinking.drag = 0.02;
    piston.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.05};
    return {{"time-stepped", Method::time_stepped, none},
            {"event-driven", Method::event_driven, none},
            {"gravity and a thermal floor", Method::event_driven, falling},
            {"drag", Method::event_driven, slowed},
            {"gravity and drag", Method::event_driven, sinking},
            {"a piston", Method::event_driven, piston}};
}

} // namespace

TEST_CASE("measurements: tables are what all discs and pairs give") {
    const Communicator world = Communicator::world();
    for (const Case& each : cases()) {
        INFO(each.name);
        TestScene test = gas(300, 0.2, 0.5, 71);
        test.setting.effects = each.effects;
        test.setting.micro_steps = 2;
        test.setting.sync_every = 24;
        test.steps = 60;
        SceneParameters scene = measured(test, each.method, 9, 5);
        scene.measurements->give("largest_velocity", 1);
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        ByHand expected;
        for (std::int64_t step = 5; step <= 60; step += 9) {
            advance_to(system, sampler, step);
            expected.add(all_of(system, world),
                         extent_at(scene.effects, scene.box, static_cast<double>(step)),
                         scene.measurements->settings.at("largest_distance").value, 1);
        }
        const std::vector<MeasuredTable> tables = sampler.tables();
        CHECK(column_of(tables, "radial_distribution", "pairs") == expected.pairs);
        CHECK(column_of(tables, "velocities", "vx_count") == expected.vx);
        CHECK(column_of(tables, "velocities", "vy_count") == expected.vy);
        CHECK(column_of(tables, "speeds", "count") == expected.speeds);
        CHECK(column_of(tables, "density_x", "count") == expected.x);
        CHECK(column_of(tables, "density_y", "count") == expected.y);
        const std::vector<double> displacement = column_of(tables, "displacement", "sum");
        REQUIRE(displacement.size() == expected.displacement.size());
        for (std::size_t k = 0; k < displacement.size(); ++k)
            CHECK(displacement[k] == Approx(expected.displacement[k]).epsilon(1e-12));
    }
}

TEST_CASE("measurements: with open sides, velocities and places of discs that are in the box") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene test = gas(300, 0.2, 0.5, 73);
        test.setting.effects.boundaries[0] = test.setting.effects.boundaries[3] = {
            BoundaryKind::open, 1, 0, 0};
        test.steps = 60;
        SceneParameters scene = measured(test, method, 9, 5);
        scene.measurements->give("largest_velocity", 1);
        scene.measurements->quantities = {"velocities", "density"};
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        ByHand expected;
        const double size = scene.box.x;
        std::size_t n_seen = 0;
        for (std::int64_t step = 5; step <= 60; step += 9) {
            advance_to(system, sampler, step);
            std::vector<Seen> discs = all_of(system, world);
            std::erase_if(discs, [size](const Seen& disc) { return disc.x < 0 || disc.y > size; });
            expected.first.clear();
            expected.add(discs, {0, size, 0, size}, 1, 1);
            n_seen += discs.size();
        }
        CHECK((system.totals().departed[0] > 10 && system.totals().departed[3] > 10));
        const std::vector<MeasuredTable> tables = sampler.tables();
        CHECK(column_of(tables, "velocities", "vx_count") == expected.vx);
        CHECK(column_of(tables, "speeds", "count") == expected.speeds);
        CHECK(column_of(tables, "density_x", "count") == expected.x);
        CHECK(column_of(tables, "density_y", "count") == expected.y);
        CHECK(column_of(tables, "velocities", "vx_density")[10] ==
              Approx(expected.vx[10] / static_cast<double>(n_seen) / 0.1).epsilon(1e-12));
    }
}

TEST_CASE("measurements: what walls have got is what discs have lost") {
    const Communicator world = Communicator::world();
    for (const Case& each : cases()) {
        INFO(each.name);
        TestScene test = gas(200, 0.2, 0.5, 72);
        test.setting.effects = each.effects;
        test.setting.sync_every = 16;
        test.steps = 80;
        if (each.effects.drag != 0) continue; // drag takes momentum, too
        const SceneParameters scene = measured(test, each.method, 8);
        DiscSystem system = system_of(scene, test, world);
        const Totals before = system.totals();
        Sampler sampler(scene, system, world);
        advance_to(system, sampler, 80);
        const Totals after = system.totals();
        const auto n = static_cast<double>(after.n_discs);
        const auto impulse = [&, tables = sampler.tables()](const char* side) {
            const bool is_upright = side[0] == 'l' ||
                                    // a piston changes the length of the other sides
                                    side[0] == 'r';
            double sum = 0;
            const std::vector<double> pressures = column_of(tables, "wall_pressure_history", side);
            for (std::size_t k = 0; k < pressures.size(); ++k) {
                const double middle = 8 * static_cast<double>(k) + 4;
                sum += pressures[k] * 8 *
                       (scene.box.x +
                        (is_upright ? 0 : scene.effects.boundaries[1].speed * middle));
            }
            return sum;
        };
        // A thermal floor also takes and gives momentum along itself.
        if (each.effects.boundaries[2].kind != BoundaryKind::thermal)
            CHECK(impulse("left") - impulse("right") + n * 80 * scene.effects.gravity.x ==
                  Approx(after.momentum_x - before.momentum_x).margin(1e-9));
        CHECK(impulse("bottom") - impulse("top") + n * 80 * scene.effects.gravity.y ==
              Approx(after.momentum_y - before.momentum_y).margin(1e-9));
        double collisions = 0;
        for (const char* side : {"left", "right", "bottom", "top"})
            collisions += column_of(sampler.tables(), "wall_pressure",
                                    std::string(side) + "_collisions")[0];
        // A corner is two collisions in the event-driven method, and one in the time-stepped one.
        CHECK(collisions == static_cast<double>(after.wall_collisions));
    }
}

TEST_CASE("measurements: a run that stores them and goes on has the same tables") {
    const Communicator world = Communicator::world();
    for (const Case& each : cases()) {
        INFO(each.name);
        TestScene test = gas(150, 0.2, 0.5, 73);
        test.setting.effects = each.effects;
        test.setting.sync_every = 16;
        test.steps = 50;
        const SceneParameters scene = measured(test, each.method, 7);
        check_going_on(scene, test, 31, 50, world); // between samples, and between syncs
    }
}

TEST_CASE(
    "measurements: sums of other keys are refused, and left aside where measuring begins later") {
    const Communicator world = Communicator::world();
    const TestScene test = gas(50, 0.1, 0.5, 74);
    const SceneParameters scene = measured(test, Method::event_driven, 2);
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    advance_to(system, sampler, 6);
    SceneParameters other = scene;
    other.measurements->every_steps = 3;
    DiscSystem same = system_of(other, test, world);
    while (same.step() < 6) same.advance_towards(6);
    Sampler finer(other, same, world);
    CHECK_THROWS_AS(finer.go_on(sampler.stored()), InputError);
    other.measurements->from_step = 6;
    finer.go_on(sampler.stored());
    finer.sample_if_due();
    CHECK(finer.tables().front().remarks.front() == "1 samples, steps 6 to 6, one every 3");
}

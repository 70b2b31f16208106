// SPDX-License-Identifier: BSD-3-Clause
// Runs with measurements, on all ranks.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include <omp.h>

#include "core/errors.hpp"
#include "measure/sampler.hpp"
#include "parallel/exchange.hpp"
#include "scene_tools.hpp"

namespace carrom::test {

/// Adds the quantities that can be measured in every box between walls.
inline SceneParameters measured(const TestScene& test, Method method, std::int64_t every_steps,
                                std::int64_t from_step = 0) {
    SceneParameters scene = scene_of(test);
    scene.method = method;
    MeasurementOutput& output = scene.measurements.emplace();
    output.every_steps = every_steps;
    output.from_step = from_step;
    output.quantities = {"wall_pressure", "radial_distribution", "velocities", "density",
                         "displacement"};
    output.give("bins", 20);
    output.give("largest_distance", 6 * scene.radius);
    return scene;
}

/// Distributes the discs over the ranks by their ids, and uses all threads.
inline DiscSystem system_of(const SceneParameters& scene, const TestScene& test,
                            const Communicator& world) {
    std::vector<InputDisc> mine;
    for (const InputDisc& disc : test.discs)
        if (disc.id % static_cast<std::uint64_t>(world.size()) ==
            static_cast<std::uint64_t>(world.rank()))
            mine.push_back(disc);
    Tuning tuning;
    tuning.threads = omp_get_max_threads();
    tuning.discs_per_thread = 1;
    return {scene, std::move(mine), world, tuning};
}

/// Advances to that step, with all samples that are due.
inline void advance_to(DiscSystem& system, Sampler& sampler, std::int64_t step) {
    sampler.sample_if_due();
    while (system.step() < step) {
        system.advance_towards(std::min(step, sampler.next_due(system.step())));
        sampler.sample_if_due();
    }
}

/// Whether both numbers are equal, or both are NaN.
inline bool are_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Checks that a run that is stored at `stop` and continued has the same tables and averages as one
/// without a stop.
inline void check_going_on(const SceneParameters& scene, const TestScene& test, std::int64_t stop,
                           std::int64_t last, const Communicator& world) {
    DiscSystem whole = system_of(scene, test, world);
    Sampler whole_sampler(scene, whole, world);
    advance_to(whole, whole_sampler, last);

    DiscSystem first = system_of(scene, test, world);
    Sampler first_sampler(scene, first, world);
    advance_to(first, first_sampler, stop);
    StoredState state = {{first.discs().begin(), first.discs().end()},
                         first.micro_steps_done(),
                         SideColumns(first.side_columns())};
    DiscSystem second(scene, std::move(state), world, {});
    Sampler sampler(scene, second, world);
    sampler.go_on(first_sampler.stored());
    advance_to(second, sampler, last);

    const std::vector<MeasuredTable> expected = whole_sampler.tables(), tables = sampler.tables();
    REQUIRE(!tables.empty());
    REQUIRE(tables.size() == expected.size());
    for (std::size_t k = 0; k < tables.size(); ++k) {
        INFO(tables[k].name);
        CHECK(tables[k].remarks == expected[k].remarks);
        REQUIRE(tables[k].rows.size() == expected[k].rows.size());
        for (std::size_t row = 0; row < tables[k].rows.size(); ++row)
            CHECK(std::ranges::equal(tables[k].rows[row], expected[k].rows[row], are_same));
    }
    const auto known = whole_sampler.averages().named(), found = sampler.averages().named();
    for (std::size_t k = 0; k < known.size(); ++k) {
        INFO(known[k].first);
        CHECK(are_same(found[k].second.value, known[k].second.value));
        CHECK(are_same(found[k].second.error, known[k].second.error));
    }
}

/// The present state of a disc in box coordinates; velocities are per step.
struct SeenDisc {
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;
};

/// All discs, in the order of ids, on every rank.
inline std::vector<SeenDisc> seen_discs(const DiscSystem& system, const Communicator& world) {
    std::vector<SeenDisc> mine;
    const double unit = system.velocity_unit(), time = system.clock();
    for (const DiscState& disc : system.shown())
        mine.push_back({disc.id, disc.x_at(time), disc.y_at(time), disc.vx * unit, disc.vy * unit});
    const std::vector<std::vector<SeenDisc>> out(static_cast<std::size_t>(world.size()), mine);
    std::vector<SeenDisc> all = send_to_owners(world, out).items;
    std::sort(all.begin(), all.end(),
              [](const SeenDisc& a, const SeenDisc& b) { return a.id < b.id; });
    return all;
}

inline void leave_out(SceneParameters& scene, const std::string& quantity) {
    std::erase(scene.measurements->quantities, quantity);
}

inline const MeasuredTable& table_of(const std::vector<MeasuredTable>& tables,
                                     const std::string& name) {
    const auto found = std::find_if(tables.begin(), tables.end(),
                                    [&](const MeasuredTable& table) { return table.name == name; });
    ensure(found != tables.end(), "no table of that name");
    return *found;
}

inline std::vector<double> column_of(const std::vector<MeasuredTable>& tables,
                                     const std::string& name, const std::string& column) {
    const MeasuredTable& table = table_of(tables, name);
    const auto found = std::find(table.columns.begin(), table.columns.end(), column);
    ensure(found != table.columns.end(), "no column of that name");
    std::vector<double> numbers;
    for (const std::vector<double>& row : table.rows)
        numbers.push_back(row[static_cast<std::size_t>(found - table.columns.begin())]);
    return numbers;
}

} // namespace carrom::test

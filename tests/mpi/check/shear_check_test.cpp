// SPDX-License-Identifier: BSD-3-Clause
// The self-check between sheared sides includes the work of moving images, and detects a wrong
// value of this work.
#include <memory>
#include <string>
#include <vector>

#include "catch.hpp"

#include "check/check_failure.hpp"
#include "check_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

TestScene sheared_gas(double speed = 0.3) {
    TestScene scene = gas(60, 0.4, speed, 64);
    const Boundary periodic{BoundaryKind::periodic, 1, 0, 0},
        sliding{BoundaryKind::sheared, 1, 0, 0};
    scene.setting.effects.boundaries = {periodic, periodic, sliding, sliding};
    scene.setting.effects.shear = 0.05;
    scene.setting.sync_every = 8;
    return scene;
}

/// The failure that the check finds in 30 steps if the engine's work of images is multiplied by
/// `factor`.
std::string failure_with(const TestScene& test, Method method, double factor,
                         const Communicator& world) {
    const SceneParameters scene = checked_scene(test, method);
    StoredState state;
    state.discs = share_of(test, world);
    if (test.setting.are_rough())
        state.columns.add(SideColumn::spin, std::vector<double>(state.discs.size(), 0.01));
    const std::unique_ptr<Engine> engine = engine_of(scene, std::move(state), world);
    StressSums stress(0x1p60); // the time-stepped engine sums this work together with the stress
    engine->add_stress_to(&stress);
    const auto spins = [&] { return engine->side_columns()[SideColumn::spin]; };
    StateCheck check(scene, engine->species_table(), engine->own(), 0, world, engine->frame(),
                     engine->clock(), spins());
    for (std::int64_t step = 1; step <= 30; ++step) {
        std::vector<Collision> log;
        double work = 0;
        engine->log_to(&log);
        engine->add_work_to(&work);
        engine->advance_towards(step);
        const LocalView now = engine->local_view();
        try {
            check.inspect(now, engine->micro_steps_done(), log, {spins()}, factor * work);
        } catch (const CheckFailure& failure) {
            return failure.what();
        }
        engine->forget_images();
    }
    return {};
}

} // namespace

TEST_CASE("check: nothing is wrong between sheared sides") {
    const Communicator world = Communicator::world();
    for (const Method method : both) {
        TestScene scene = sheared_gas();
        CHECK(failure_with(scene, method, 1, world).empty());
        scene.setting.effects.contact = {ContactKind::restitution, 0.8, 0.001};
        CHECK(failure_with(scene, method, 1, world).empty());
        scene.setting.effects.contact = {ContactKind::rough, 0.9, 0.001, 0.5, 0.4, 0.5};
        scene.setting.effects.species = {{20, 1, 5}, {40, 0.7, 0.3}};
        CHECK(failure_with(scene, method, 1, world).empty());
    }
}

TEST_CASE("check: discs may be far slower than images between sheared sides") {
    const Communicator world = Communicator::world();
    for (const Method method : both)
        for (const double speed : {1e-2, 1e-4, 1e-6})
            CHECK(failure_with(sheared_gas(speed), method, 1, world).empty());
}

TEST_CASE("check: energy that is not the work of images is found") {
    const Communicator world = Communicator::world();
    for (const Method method : both)
        for (const double factor : {0.0, 0.999, 1.001})
            CHECK_FALSE(failure_with(sheared_gas(), method, factor, world).empty());
}

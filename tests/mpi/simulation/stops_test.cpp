// SPDX-License-Identifier: BSD-3-Clause
// Runs that stop at each step, like a run that is analysed between steps. Windows continue after
// stops, and at each stop the state is that of the reference programs.
#include <algorithm>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"
#include <omp.h>

#include "core/errors.hpp"
#include "core/state_hash.hpp"
#include "engine/engine.hpp"
#include "event_driven.hpp"
#include "gathered.hpp"
#include "scene_tools.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"
#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// At the speed 0.1 a disc meets another one in some ten steps, so that a window would be several
/// steps long.
TestScene slow_gas(bool is_periodic, double speed = 0.1) {
    TestScene scene = gas(200, 0.3, speed, 611);
    scene.steps = 40;
    scene.setting.sync_every = 16;
    const Boundary side{is_periodic ? BoundaryKind::periodic : BoundaryKind::wall, 1, 0, 0};
    scene.setting.effects.boundaries = {side, side, side, side};
    return scene;
}

DiscSystem start(const TestScene& scene, Method method, const Communicator& world) {
    SceneParameters all = scene_of(scene);
    all.method = method;
    Tuning tuning;
    tuning.threads = omp_get_max_threads();
    tuning.discs_per_thread = 1;
    return {all, share_of(scene, world.rank(), world.size(), 5), world, tuning};
}

StateHash hash_at(const DiscSystem& system, const Communicator& world) {
    return hash_of(gathered(system.discs(), world));
}

using Strides = std::vector<std::int64_t>; ///< steps from stop to stop, again and again

const Strides each_step = {1};
/// The engine expects stops at steps 4, 8, 12, ..., and the third one comes at step 9.
const Strides uneven = {4, 4, 1, 2, 1, 3, 1};

/// Calls `at_stop` at each stop of the run.
template <class AtStop>
void run_with_stops(DiscSystem& system, std::int64_t last, const Strides& strides,
                    const AtStop& at_stop) {
    for (std::size_t k = 0; system.step() < last; ++k) {
        advance_to(system, std::min(last, system.step() + strides[k % strides.size()]));
        at_stop();
    }
}

template <class Reference>
void check_each_stop(bool is_periodic, Method method, const Strides& strides) {
    const Communicator world = Communicator::world();
    const TestScene scene = slow_gas(is_periodic);
    Reference reference(scene.setting, scene.discs);
    std::int64_t step_of_reference = 0;
    DiscSystem system = start(scene, method, world);
    run_with_stops(system, scene.steps, strides, [&] {
        reference.run_steps(system.step() - std::exchange(step_of_reference, system.step()));
        INFO(scene.name << ", step " << system.step());
        const StateHash here = hash_at(system, world);
        if (world.is_root()) CHECK(to_string(here) == to_string(hash_of(reference.discs())));
        // Totals redistribute all discs, so they end a window early.
        if (system.step() % 7 != 5) return;
        const StateHash of_totals = system.totals().hash;
        if (world.is_root()) CHECK(to_string(of_totals) == to_string(here));
    });
}

/// What a run has recorded up to a stop, summed over ranks modulo 2^64.
std::vector<std::uint64_t> recorded(const DiscSystem& system, const std::vector<Collision>& log,
                                    const Communicator& world) {
    std::vector<std::uint64_t> sums = {log.size(), 0};
    for (const Collision& collision : log)
        sums[1] += std::bit_cast<std::uint64_t>(collision.time) ^
                   (collision.p * 1000 + collision.q);
    for (const ExactSum* part : system.stress_sums().parts()) sums.push_back(part->low_word());
    world.sum(sums);
    return sums;
}

/// Windows of a run that stops after each `every` steps.
std::uint64_t n_windows(const TestScene& scene, std::int64_t every) {
    DiscSystem system = start(scene, Method::event_driven, Communicator::world());
    run_with_stops(system, scene.steps, {every}, [] {});
    return system.engine().rollback_counts().windows;
}

/// A disc comes down on a row of discs that touch from wall to wall, which then collide without
/// end.
TestScene row_that_is_hit() {
    TestScene scene = empty_scene("a row from wall to wall", 20, 0.5, 40);
    scene.setting.sync_every = 8;
    for (int k = 0; k < 20; ++k) add_disc(scene, 0.5 + k, 10);
    add_disc(scene, 7.25, 13, 0, -0.1);
    return scene;
}

/// The last step of a run that stops at every step and ends in an error.
std::int64_t step_before_error(const TestScene& scene, bool redistributes) {
    const Communicator world = Communicator::world();
    DiscSystem system = start(scene, Method::event_driven, world);
    try {
        run_with_stops(system, scene.steps, each_step, [&] {
            if (redistributes) system.totals();
        });
    } catch (const CollectiveError& error) {
        CHECK(std::string(error.what()).find("collides without end") != std::string::npos);
    }
    return system.step();
}

} // namespace

TEST_CASE("stops: each has the state of the reference, whatever is asked for there") {
    for (const bool is_periodic : {false, true}) {
        for (const Strides& strides : {each_step, uneven}) {
            using namespace reference;
            check_each_stop<TimeSteppedReference>(is_periodic, Method::time_stepped, strides);
            check_each_stop<EventDrivenReference>(is_periodic, Method::event_driven, strides);
        }
    }
}

TEST_CASE("stops: records have all that happened before them, and no more") {
    const Communicator world = Communicator::world();
    for (const Strides& strides : {each_step, uneven}) {
        const TestScene scene = slow_gas(true);
        DiscSystem system = start(scene, Method::event_driven, world),
                   other = start(scene, Method::event_driven, world);
        std::vector<Collision> log, log_of_other;
        run_with_stops(system, scene.steps, strides, [&] {
            advance_to(other, system.step());
            other.totals(); // its windows end at stops
            INFO("step " << system.step());
            CHECK(recorded(system, log, world) == recorded(other, log_of_other, world));
            // Where the log begins, a window has already run beyond the stop.
            system.log_to(system.step() > 10 ? &log : nullptr);
            other.log_to(system.step() > 10 ? &log_of_other : nullptr);
        });
        CHECK(world.sum(std::uint64_t{log.size()}) > 100);
    }
}

TEST_CASE("stops: an error comes in the step in which it happens") {
    const TestScene scene = row_that_is_hit();
    const std::int64_t last = step_before_error(scene, true);
    CHECK(last > 16);
    CHECK(last < 24);
    CHECK(step_before_error(scene, false) == last);
}

TEST_CASE("stops: windows go on after them") {
    for (const bool is_periodic : {false, true}) {
        const TestScene scene = slow_gas(is_periodic, 0.03);
        const std::uint64_t in_one_call = n_windows(scene, scene.steps);
        // At the first stop the engine still expects a redistribution, which ends a window.
        CHECK(n_windows(scene, 1) <= 2 * in_one_call);
        CHECK(2 * in_one_call < static_cast<std::uint64_t>(scene.steps) / 2);
    }
}

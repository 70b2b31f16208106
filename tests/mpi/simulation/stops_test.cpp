// SPDX-License-Identifier: BSD-3-Clause
// Runs that stop at each step, as a program does that analyses them: windows go on after stops, and
// at each stop the state equals that of the reference.
#include <array>
#include <string>

#include "catch.hpp"
#include <omp.h>

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

/// A disc collides once in some ten steps, so that a window would be several steps long.
TestScene slow_gas(bool is_periodic) {
    TestScene scene = gas(200, 0.3, 0.1, 611);
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

template <class Reference> void check_each_stop(bool is_periodic, Method method) {
    const Communicator world = Communicator::world();
    const TestScene scene = slow_gas(is_periodic);
    Reference reference(scene.setting, scene.discs);
    DiscSystem system = start(scene, method, world);
    while (system.step() < scene.steps) {
        advance_to(system, system.step() + 1);
        reference.run_steps(1);
        INFO(scene.name << ", step " << system.step());
        const StateHash here = hash_at(system, world);
        if (world.is_root()) CHECK(to_string(here) == to_string(hash_of(reference.discs())));
        // Totals redistribute all discs, which ends a window early.
        if (system.step() % 7 != 5) continue;
        const StateHash of_totals = system.totals().hash;
        if (world.is_root()) CHECK(to_string(of_totals) == to_string(here));
    }
}

/// Windows of a run that stops after each `every` steps.
std::uint64_t n_windows(const TestScene& scene, std::int64_t every) {
    DiscSystem system = start(scene, Method::event_driven, Communicator::world());
    while (system.step() < scene.steps) advance_to(system, system.step() + every);
    return system.engine().rollback_counts().windows;
}

} // namespace

TEST_CASE("stops: each has the state of the reference, whatever is asked for there") {
    for (const bool is_periodic : {false, true}) {
        check_each_stop<reference::TimeSteppedReference>(is_periodic, Method::time_stepped);
        check_each_stop<reference::EventDrivenReference>(is_periodic, Method::event_driven);
    }
}

TEST_CASE("stops: a single block goes on in its window after them") {
    const Communicator world = Communicator::world();
    // on several ranks or threads windows end at stops
    if (world.size() > 1 || omp_get_max_threads() > 1) return;
    for (const bool is_periodic : {false, true}) {
        const TestScene scene = slow_gas(is_periodic);
        const std::uint64_t in_one_call = n_windows(scene, scene.steps);
        // At the first stop the engine still expects a redistribution, which ends a window.
        CHECK(n_windows(scene, 1) <= 2 * in_one_call);
        CHECK(2 * in_one_call < static_cast<std::uint64_t>(scene.steps) / 2);
    }
}

// SPDX-License-Identifier: BSD-3-Clause
#include "effect_runs.hpp"

#include <utility>

#include "catch.hpp"
#include <omp.h>

#include "dynamics/drag.hpp"
#include "dynamics/falling_frame.hpp"
#include "dynamics/fixed_bodies.hpp"

namespace carrom::test {

namespace {

std::vector<InputDisc> share_of(const TestScene& scene, const Communicator& world) {
    return share_of(scene, world.rank(), world.size(), 5);
}

/// Most stops leave the present window unfinished; computing the totals ends the window.
void advance_step_by_step(DiscSystem& system, std::int64_t last_step) {
    while (system.step() < last_step) {
        advance_to(system, system.step() + 1);
        if (system.step() % 7 == 3) static_cast<void>(system.totals());
    }
}

} // namespace

DiscSystem system_of(const TestScene& scene, Method method, const Communicator& world,
                     const Tuning& tuning) {
    SceneParameters all = scene_of(scene);
    all.method = method;
    Tuning threaded = tuning;
    threaded.threads = omp_get_max_threads();
    threaded.discs_per_thread = 1;
    return {all, share_of(scene, world), world, threaded};
}

Totals run_with_restart(const TestScene& scene, Method method, const Communicator& world) {
    DiscSystem first = system_of(scene, method, world);
    advance_step_by_step(first, scene.steps / 2);
    SceneParameters again = scene_of(scene);
    again.method = method;
    Tuning in_groups;
    in_groups.ranks_across = 2;
    DiscSystem second(again,
                      {{first.discs().begin(), first.discs().end()},
                       first.micro_steps_done(),
                       SideColumns(first.side_columns())},
                      world, in_groups);
    advance_step_by_step(second, scene.steps);
    return second.totals();
}

void check_shared_run(const TestScene& scene, Method method, const Communicator& world) {
    SceneParameters whole = scene_of(scene);
    whole.method = method;
    DiscSystem shared = system_of(scene, method, world);
    DiscSystem single(whole, scene.discs, Communicator::of_this_rank(), Tuning{});
    shared.check_every_step(whole);
    CHECK_NOTHROW(advance_to(shared, scene.steps));
    advance_to(single, scene.steps);
    CHECK(shared.totals().hash == single.totals().hash);
}

void make_room_for_obstacles(TestScene& scene) {
    const reference::Setting& setting = scene.setting;
    const FixedBodies obstacles(setting.box(), setting.radius, setting.effects);
    for (const InputDisc& disc : std::exchange(scene.discs, {}))
        if (obstacles.deepest_overlap(disc.x, disc.y, setting.radius, 0).body ==
            BodyContact::no_body)
            add_disc(scene, disc.x, disc.y, disc.vx, disc.vy);
}

void set_drag(TestScene& scene, double rate) {
    reference::Setting& setting = scene.setting;
    setting.effects.drag = rate;
    const double c = rate / static_cast<double>(setting.micro_steps);
    if (!(c > 0)) return;
    setting.drag_clock = [c](double n) { return drag_clock(c, n); };
    setting.dragged_fall = [c](double clock) { return dragged_fall(c, clock); };
    setting.dragged_fall_delay = [c](double distance, double velocity, double pull) {
        return dragged_fall_delay(distance, velocity, pull, c);
    };
}

Totals run(const TestScene& scene, Method method, const Communicator& world, const Tuning& tuning) {
    DiscSystem system = system_of(scene, method, world, tuning);
    advance_to(system, scene.steps);
    return system.totals();
}

} // namespace carrom::test

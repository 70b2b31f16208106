// SPDX-License-Identifier: BSD-3-Clause
// Family 8, long: errors that appear only after many steps or collisions.
//
// Why hard: counters of 32 bits wrap after hours. A time that counts from the start of the run
// loses a digit with every factor of ten, until t + dt == t and time stops. Energies drift.
// Sources: the trackers' threads on long runs (counters, negative times after a restart); Bannerman
// et al. 2014. Bounds: energy to 1e-12 after 1e9 collisions, the same bits after a restart and for
// any first value of the count of steps.
#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "core/state_hash.hpp"
#include "hold.hpp"
#include "runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};

/// The run's state as a checkpoint stores it.
StoredState stored(const DiscSystem& system) {
    return {{system.discs().begin(), system.discs().end()}, system.micro_steps_done()};
}

DiscSystem resume(const TestScene& scene, Method method, StoredState state) {
    SceneParameters checked = scene_of(scene);
    checked.method = method;
    return {checked, std::move(state), Communicator::world(), {}};
}

TestScene some_gas() {
    TestScene scene = gas(100, 0.4, 0.3, 801);
    scene.setting.micro_steps = 2;
    scene.setting.sync_every = 8;
    return scene;
}

constexpr std::uint64_t all_bits_of_counters = (std::uint64_t{1} << 47) - 1;

/// A run like some_gas over 20 steps that begins at `micro_steps`, with counters that begin at
/// `counted`.
Outcome later(Method method, std::int64_t micro_steps, std::uint64_t counted) {
    const TestScene scene = some_gas();
    StoredState state = stored(start(scene, method));
    state.micro_steps_done = micro_steps;
    for (DiscState& disc : state.discs) {
        disc.wall_collisions = (disc.wall_collisions + counted) & all_bits_of_counters;
        disc.pair_collisions = (disc.pair_collisions + counted) & all_bits_of_counters;
    }
    DiscSystem system = resume(scene, method, state);
    CHECK(system.step() == micro_steps / 2);
    run_to(system, micro_steps / 2 + 20);
    Outcome outcome = outcome_of(system);
    for (DiscState& disc : outcome.discs) {
        disc.wall_collisions = (disc.wall_collisions - counted) & all_bits_of_counters;
        disc.pair_collisions = (disc.pair_collisions - counted) & all_bits_of_counters;
    }
    return outcome;
}

bool has_same_bits(const Outcome& a, const Outcome& b) {
    return hash_of(a.discs) == hash_of(b.discs);
}

/// The state 20 steps later in a run that is stopped and started again.
Outcome with_restart(const TestScene& scene, Method method, StoredState state) {
    DiscSystem first = resume(scene, method, std::move(state));
    const std::int64_t step = first.step();
    run_to(first, step + 7);
    DiscSystem second = resume(scene, method, stored(first));
    run_to(second, step + 20);
    return outcome_of(second);
}

/// Runs `most` collisions in `parts` parts. After each part the energy and the hash after a restart
/// are checked.
void many_collisions(Method method, std::size_t n, double most, int parts) {
    TestScene scene = gas(n, 0.3, 0.5, 803);
    scene.steps = std::int64_t{1} << 40;
    DiscSystem system = start(scene, method);
    const double energy = squared_speeds(outcome_of(system));
    double worst = 0, n_different = 0;
    for (int part = 1; part <= parts; ++part) {
        while (static_cast<double>(system.totals().pair_collisions) < most * part / parts)
            run_to(system, system.step() + 50);
        const Outcome again = with_restart(scene, method, stored(system));
        run_to(system, system.step() + 20);
        const Outcome now = outcome_of(system);
        n_different += !has_same_bits(now, again);
        worst = std::max(worst, std::fabs(squared_speeds(now) / energy - 1));
    }
    const std::string what = number(most) + " collisions of " + std::to_string(n) + " discs";
    hold("long", what + ": change of the energy", name_of(method), worst, 1e-12);
    hold("long", what + ": other bits after a restart", name_of(method), n_different, 0);
}

} // namespace

TEST_CASE("long: steps above 2^32 and up to 2^53 have the bits of the first ones", "[long]") {
    for (const Method method : both) {
        const Outcome expected = later(method, 0, 0);
        double n_different = 0;
        for (const int bits : {31, 32, 40, 52}) {
            // From 16 micro-steps before the boundary to beyond it.
            n_different += !has_same_bits(later(method, (std::int64_t{1} << bits) - 16, 0),
                                          expected);
        }
        hold("long", "steps across 2^31, 2^32, 2^40, 2^52: runs with other bits", name_of(method),
             n_different, 0);
    }
}

TEST_CASE("long: counters above 2^32 go on counting", "[long]") {
    for (const Method method : both) {
        const Outcome expected = later(method, 0, 0);
        double n_different = 0;
        for (const std::uint64_t counted :
             {(std::uint64_t{1} << 31) - 2, (std::uint64_t{1} << 32) - 2, std::uint64_t{1} << 50}) {
            n_different += !has_same_bits(later(method, 0, counted), expected);
        }
        hold("long", "counters across 2^31, 2^32, at 2^50: runs with other bits", name_of(method),
             n_different, 0);
    }
}

// Times count from the last sync, so t + dt == t does not depend on the length of the run, but on
// sync_every.
TEST_CASE("long: contacts late in a long sync interval are not lost", "[long]") {
    for (const Method method : both) {
        for (const int bits : {10, 20, 30}) {
            TestScene scene = empty_scene("late contacts", 160, 0.5, 0);
            scene.setting.sync_every = std::int64_t{1} << bits;
            Random random(804);
            const double speed = 0.125;
            for (int cell = 0; cell < 64; ++cell) {
                const auto [ex, ey] = random.direction();
                const double x = 10 + 20 * (cell % 8), y = 10 + 20 * (cell / 8),
                             gap = 0.5 * random.uniform(0, 1);
                add_disc(scene, x, y, speed * ex, speed * ey);
                add_disc(scene, x + (1 + gap) * ex, y + (1 + gap) * ey, -speed * ex, -speed * ey);
            }
            StoredState state = stored(start(scene, method));
            state.micro_steps_done = (std::int64_t{1} << bits) -
                                     6; // from here the discs fly beyond the sync
            for (DiscState& disc : state.discs)
                disc.tau = static_cast<double>(state.micro_steps_done);
            DiscSystem system = resume(scene, method, state);
            run_to(system, system.step() + 12);
            const auto met = static_cast<double>(system.totals().pair_collisions);
            hold("long",
                 "contacts before and after a sync at 2^" + std::to_string(bits) +
                     ": lost or repeated, of 64",
                 name_of(method), std::fabs(met - 64), 0);
        }
    }
}

// A time is rounded to an ulp of its size. An overlap may be as deep as a disc flies in that time.
TEST_CASE("long: late in a long sync interval overlaps are as deep as times are coarse", "[long]") {
    for (const int bits : {6, 20, 30}) {
        TestScene scene = gas(64, 0.4, 0.3, 805);
        scene.setting.sync_every = std::int64_t{1} << bits;
        StoredState state = stored(start(scene, Method::event_driven));
        state.micro_steps_done = scene.setting.sync_every - 40;
        for (DiscState& disc : state.discs) disc.tau = static_cast<double>(state.micro_steps_done);
        DiscSystem system = resume(scene, Method::event_driven, state);
        double worst = 0;
        for (int step = 0; step < 60; ++step) {
            run_to(system, system.step() + 1);
            const Outcome now = outcome_of(system);
            const double speed = std::sqrt(squared_speeds(now));
            const double bound = 64 * ulp_of(scene.setting.box_size) +
                                 2 * speed * ulp_of(std::ldexp(0.5, bits));
            worst = std::max(worst, deepest_overlap(now, 2) / bound);
        }
        hold("long",
             "sync_every 2^" + std::to_string(bits) +
                 ": deepest overlap over 64 ulp(L) + 2 |v| ulp(time)",
             "event-driven", worst, 1);
    }
}

// Discs are so fast that a flight from wall to wall takes less than an ulp of the time: t + dt ==
// t. Then the collision cascade must end the run; one collision a step is no problem.
TEST_CASE("long: discs faster than times can tell end in finite time, with their energy",
          "[long]") {
    double worst = 0, outside = 0;
    for (const double speed : {0x1p30, 0x1p52, 0x1p60, 0x1p200}) {
        TestScene scene = gas(16, 0.2, speed, 806);
        scene.steps = 130;
        const Outcome before = outcome_of(start(scene, Method::time_stepped)),
                      after = run(scene, Method::time_stepped);
        worst = std::max(worst, std::fabs(squared_speeds(after) / squared_speeds(before) - 1));
        const double allowed = 4 * ulp_of(scene.setting.box_size) +
                               std::sqrt(squared_speeds(after)) * ulp_of(32);
        outside = std::max(outside, farthest_outside(after, scene.setting) / allowed);
    }
    hold("long", "2^30 to 2^200 diameters a step: change of the energy", "time-stepped", worst,
         1e-12);
    hold("long", "2^30 to 2^200 diameters a step: farthest outside over 4 ulp(L) + |v| ulp(64)",
         "time-stepped", outside, 1);
}

TEST_CASE("long: energy and restarts over 2e5 collisions", "[long]") {
    many_collisions(Method::time_stepped, 400, 1e5, 4);
    many_collisions(Method::event_driven, 400, 1e5, 4);
}

TEST_CASE("long: energy and restarts over 1e9 collisions, rule all", "[long][.hours]") {
    many_collisions(Method::event_driven, 10000, 1e9, 10);
}

TEST_CASE("long: energy and restarts over 1e9 collisions, rule one", "[long][.hours]") {
    many_collisions(Method::time_stepped, 10000, 1e9, 10);
}

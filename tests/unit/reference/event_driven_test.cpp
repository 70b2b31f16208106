// SPDX-License-Identifier: BSD-3-Clause
// The reference of the event-driven method compared with scenes solved by hand, the laws of
// mechanics, and the time-stepped method where both agree.
#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "event_driven.hpp"
#include "scenes.hpp"
#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::test;
using reference::Event;
using reference::EventDrivenReference;

namespace {

double energy(std::span<const DiscState> discs) {
    double sum = 0;
    for (const DiscState& disc : discs) sum += 0.5 * (disc.vx * disc.vx + disc.vy * disc.vy);
    return sum;
}

Event pair_event(double time, std::uint32_t generation, DiscId p, DiscId q) {
    return {time, generation, p, true, q, 0};
}
Event wall_event(double time, std::uint32_t generation, DiscId p, DiscId axis) {
    return {time, generation, p, false, axis, 0};
}

} // namespace

TEST_CASE("all: a touching cradle passes its blow on at one time, generation by generation") {
    EventDrivenReference run(
        {32, 1, 1, 64},
        std::vector<InputDisc>{{0, 4, 8, 1, 0}, {3, 7, 8}, {1, 9, 8}, {2, 11, 8}, {4, 14, 8}});
    run.run_micro_steps(1);
    // The contact at time 1 is at the end of the micro-step, so it belongs to this micro-step, and
    // so do all collisions that follow from it.
    CHECK(run.log() == std::vector<Event>{pair_event(1, 0, 0, 3), pair_event(1, 1, 1, 3),
                                          pair_event(1, 2, 1, 2)});
    CHECK(run.discs()[2].vx == 1);
    CHECK(run.discs()[0].vx == 0);
    run.run_micro_steps(1);
    CHECK(run.log().back() == pair_event(2, 0, 2, 4));
    CHECK(run.pair_collisions() == 4);
}

TEST_CASE("all: two blows at one time are taken by id, then by generation") {
    // Discs 0 and 2 reach disc 1, which rests, from both sides at t = 1. (1,g0,0,1) comes first,
    // and then 1 meets 2 at once.
    EventDrivenReference run(
        {32, 1, 1, 64}, std::vector<InputDisc>{{0, 13, 8, 1, 0}, {1, 16, 8}, {2, 19, 8, -1, 0}});
    run.run_micro_steps(2);
    CHECK(run.log() == std::vector<Event>{pair_event(1, 0, 0, 1), pair_event(1, 1, 1, 2),
                                          pair_event(1, 2, 0, 1)});
    CHECK(run.discs()[0].vx == -1);
    CHECK(run.discs()[1].vx == 0);
    CHECK(run.discs()[2].vx == 1);
}

TEST_CASE("all: a corner is two wall collisions, x before y, and no disc ever waits at a wall") {
    EventDrivenReference run({4, 1, 1, 64}, std::vector<InputDisc>{{0, 2, 2, -2, -2}});
    run.run_micro_steps(1);
    CHECK(run.log() == std::vector<Event>{wall_event(0.5, 0, 0, Event::wall_x),
                                          wall_event(0.5, 1, 0, Event::wall_y)});
    CHECK(run.wall_collisions() == 2);
    CHECK(run.discs()[0].wall_collisions == 2);
    EventDrivenReference fast({4, 1, 1, 64}, std::vector<InputDisc>{{0, 2, 1.5, -64, 0}});
    fast.run_micro_steps(1);
    // A free length of 2 at speed 64: walls are hit at 1/64, 3/64, ... 63/64.
    CHECK(fast.wall_collisions() == 32);
    CHECK(fast.discs()[0].tau == 63.0 / 64);
}

TEST_CASE("all: walls come before pairs at the same time and disc") {
    EventDrivenReference run({16, 1, 1, 64},
                             std::vector<InputDisc>{{0, 2, 8, -2, 0}, {1, 4.5, 8, -3, 0}});
    run.run_micro_steps(1);
    REQUIRE(run.log().size() >= 2);
    CHECK(run.log()[0] == wall_event(0.5, 0, 0, Event::wall_x));
    CHECK(run.log()[1] == pair_event(0.5, 1, 0, 1));
}

TEST_CASE("all: overlapping pairs collide at once if they approach, never if they separate") {
    EventDrivenReference approaching({16, 1, 1, 64},
                                     std::vector<InputDisc>{{0, 6, 8, 1, 0}, {1, 7.5, 8, -1, 0}});
    approaching.run_micro_steps(2);
    CHECK(approaching.log() == std::vector<Event>{pair_event(0, 0, 0, 1)});
    EventDrivenReference separating({16, 1, 1, 64},
                                    std::vector<InputDisc>{{0, 6, 8, -1, 0}, {1, 7.5, 8, 1, 0}});
    separating.run_micro_steps(2);
    CHECK(separating.log().empty());
}

TEST_CASE("all: a collision at the sync time happens before the sync") {
    EventDrivenReference run({32, 1, 1, 2}, std::vector<InputDisc>{{0, 10, 8, 1, 0}, {1, 14, 8}});
    run.run_micro_steps(2);
    CHECK(run.log() == std::vector<Event>{pair_event(2, 0, 0, 1)});
    CHECK(run.clock() == 0);
    CHECK(run.discs()[0].tau == 0);
    CHECK(run.discs()[1].vx == 1);
    run.run_micro_steps(1);
    CHECK(run.discs()[1].x == 14);
}

TEST_CASE("all: energy stays, the log is in order, no pair is left overlapping") {
    std::uint64_t collisions = 0;
    for (const auto family : {gases, still_gases, cradles, chains, lattices, breaks, wall_scenes}) {
        for (const TestScene& scene : family()) {
            if (scene.cascades_when_event_driven || scene.discs.size() > 60) continue;
            INFO(scene.name);
            EventDrivenReference run(scene.setting, scene.discs);
            const double before = energy(run.discs());
            for (std::int64_t step = 0; step < scene.steps && run.log().size() < 1000; ++step)
                run.run_steps(1);
            CHECK(energy(run.discs()) == Approx(before).epsilon(1e-11));
            collisions += run.log().size();
            CHECK(std::is_sorted(
                run.log().begin(), run.log().end(), [](const Event& a, const Event& b) {
                    return std::make_tuple(a.sync, a.time) < std::make_tuple(b.sync, b.time);
                }));
            double deepest = 0;
            for (const DiscState& p : run.discs()) {
                for (const DiscState& q : run.discs()) {
                    if (q.id <= p.id) continue;
                    const double dx = (q.x + q.vx * (run.clock() - q.tau)) -
                                      (p.x + p.vx * (run.clock() - p.tau));
                    const double dy = (q.y + q.vy * (run.clock() - q.tau)) -
                                      (p.y + p.vy * (run.clock() - p.tau));
                    deepest = std::max(deepest,
                                       2 * scene.setting.radius - std::sqrt(dx * dx + dy * dy));
                }
            }
            CHECK(deepest < 1e-12 * scene.setting.box_size);
        }
    }
    CHECK(collisions > 20000);
}

TEST_CASE("all: agrees with the time-stepped method while no disc is due twice in a micro-step") {
    std::uint64_t collisions = 0;
    for (TestScene scene : gases()) {
        scene.setting.micro_steps *= 64;
        INFO(scene.name);
        reference::TimeSteppedReference one(scene.setting, scene.discs);
        EventDrivenReference all(scene.setting, scene.discs);
        for (std::int64_t n = 0; n < 512; ++n) {
            one.run_micro_steps(1);
            all.run_micro_steps(1);
            if (one.counters().rejected_candidates > 0) break;
            const std::uint64_t done = one.log().size();
            if (done > scene.discs.size() || done != all.log().size())
                break; // trajectories diverge, or a disc has collided twice
            double gap = 0;
            for (std::size_t i = 0; i < scene.discs.size(); ++i) {
                gap = std::max(gap, std::fabs(one.discs()[i].x - all.discs()[i].x));
                gap = std::max(gap, std::fabs(one.discs()[i].y - all.discs()[i].y));
            }
            CHECK(gap < 1e-7);
        }
        collisions += std::min(one.log().size(), all.log().size());
    }
    CHECK(collisions > 500);
}

TEST_CASE("all: endless collisions are reported, not waited for") {
    EventDrivenReference run({2, 1, 1, 64}, std::vector<InputDisc>{{0, 1, 1, 1, 0}}, 10000);
    CHECK_THROWS_AS(run.run_micro_steps(1), std::runtime_error);
}

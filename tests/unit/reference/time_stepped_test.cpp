// SPDX-License-Identifier: BSD-3-Clause
// The reference compared with small scenes solved by hand, in numbers that are exact in binary.
#include "catch.hpp"

#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::reference;

namespace {

TimeSteppedReference after(std::int64_t micro_steps, const Setting& setting,
                           const std::vector<InputDisc>& discs) {
    TimeSteppedReference run(setting, discs);
    run.run_micro_steps(micro_steps);
    return run;
}

void check_state(const DiscState& disc, double x, double y, double vx, double vy, double tau) {
    CAPTURE(disc.id);
    CHECK(disc.x == x);
    CHECK(disc.y == y);
    CHECK(disc.vx == vx);
    CHECK(disc.vy == vy);
    CHECK(disc.tau == tau);
}

} // namespace

TEST_CASE("a free disc keeps its state until the sync") {
    const std::vector<InputDisc> discs = {{0, 2, 3, 0.5, -0.25}};
    const TimeSteppedReference before = after(3, {8, 1, 1, 4}, discs);
    check_state(before.discs()[0], 2, 3, 0.5, -0.25, 0);
    CHECK(before.clock() == 3);
    const TimeSteppedReference synced = after(4, {8, 1, 1, 4}, discs);
    check_state(synced.discs()[0], 4, 2, 0.5, -0.25, 0);
    CHECK(synced.clock() == 0);
}

TEST_CASE("velocities are divided by the micro-steps") {
    const TimeSteppedReference run = after(1, {8, 1, 4, 64}, {{0, 2, 3, 0.5, -0.25}});
    check_state(run.discs()[0], 2, 3, 0.125, -0.0625, 0);
}

TEST_CASE("a pair meets head on and swaps velocities") {
    // A gap of 2 closes at 0.5 a step. The contact at 4 is the end of micro-step 3 and the start of
    // 4; it belongs to the earlier one.
    const std::vector<InputDisc> discs = {{0, 4, 8, 0.5, 0}, {1, 8, 8, 0, 0}};
    CHECK(after(3, {16, 1, 1, 64}, discs).log().empty());
    const TimeSteppedReference run = after(5, {16, 1, 1, 64}, discs);
    check_state(run.discs()[0], 6, 8, 0, 0, 4);
    check_state(run.discs()[1], 8, 8, 0.5, 0, 4);
    REQUIRE(run.log().size() == 1);
    CHECK(run.log()[0] == Collision{3, 1.0, 0, 1});
    CHECK(run.counters() == Counters{1, 0, 0, 1});
    CHECK(run.discs()[0].pair_collisions == 1);
    CHECK(run.discs()[1].pair_collisions == 1);
}

TEST_CASE("an oblique contact turns the normal part only") {
    // Separation (6, 8) at contact, sigma 10: a 3-4-5 triangle. P moves in x at 25/8: w.e = -75/4,
    // e.e = 100.
    const std::vector<InputDisc> discs = {{1, 40, 40, 0, 0}, {0, 34 - 3.125 * 0.5, 32, 3.125, 0}};
    const TimeSteppedReference run = after(1, {100, 5, 1, 64}, discs);
    REQUIRE(run.log().size() == 1);
    CHECK(run.log()[0].t == Approx(0.5).epsilon(1e-14));
    CHECK(run.discs()[0].vx == Approx(2.0).epsilon(1e-13));
    CHECK(run.discs()[0].vy == Approx(-1.5).epsilon(1e-13));
    CHECK(run.discs()[1].vx == Approx(1.125).epsilon(1e-13));
    CHECK(run.discs()[1].vy == Approx(1.5).epsilon(1e-13));
}

TEST_CASE("a graze and equal velocities are no contact") {
    CHECK(after(8, {16, 1, 1, 64}, {{0, 4, 8, 1, 0}, {1, 8, 10, 0, 0}}).log().empty());
    CHECK(after(8, {32, 1, 1, 64}, {{0, 4, 8, 1, 0}, {1, 6, 8, 1, 0}}).log().empty());
}

TEST_CASE("a wall sends a disc back, once per micro-step") {
    // The wall for centres is at 1. From 2 at -4 a step the disc is there at t = 1/4, and then
    // flies 3 units back without a stop.
    const TimeSteppedReference run = after(1, {16, 1, 1, 64}, {{0, 2, 8, -4, 0}});
    check_state(run.discs()[0], 1, 8, 4, 0, 0.25);
    CHECK(run.log()[0] == Collision{0, 0.25, 0, Collision::wall});
    CHECK(run.counters() == Counters{1, 0, 1, 0});
    CHECK(run.discs()[0].wall_collisions == 1);
}

TEST_CASE("a disc that would leave by the other wall waits there") {
    // Bounces at t = 1/8 and ends the step at 8, inside: not stopped.
    const TimeSteppedReference run = after(1, {16, 1, 1, 64}, {{0, 2, 8, -8, 1}});
    check_state(run.discs()[0], 1, 8.125, 8, 1, 0.125);
    const TimeSteppedReference fast = after(1, {16, 1, 1, 64}, {{0, 2, 8, -32, 1}});
    // The bounce is at t = 1/32; then 14 units to the high wall at 32 a step: ts = 7/16, y = 8 +
    // 1/32 + 7/16.
    check_state(fast.discs()[0], 15, 8.46875, 32, 1, 1);
    CHECK(fast.counters() == Counters{1, 0, 1, 0});
    const TimeSteppedReference next = after(2, {16, 1, 1, 64}, {{0, 2, 8, -32, 1}});
    CHECK(next.log()[1] == Collision{1, 0.0, 0, Collision::wall});
    check_state(next.discs()[0], 1, 8.46875 + 0.4375, -32, 1, 2);
}

TEST_CASE("a corner counts once and turns both axes") {
    const TimeSteppedReference run = after(1, {16, 1, 1, 64}, {{0, 2, 2, -2, -2}});
    check_state(run.discs()[0], 1, 1, 2, 2, 0.5);
    CHECK(run.counters().wall_collisions == 1);
    // The later axis is off by less than the band of 1e-8: still one corner.
    const TimeSteppedReference near = after(1, {16, 1, 1, 64}, {{0, 2, 2 + 0x1p-28, -2, -2}});
    check_state(near.discs()[0], 1, 1 + 0x1p-28, 2, 2, 0.5);
    // Off by more: the disc stops at the other wall, and bounces there in the next micro-step.
    const TimeSteppedReference off = after(1, {16, 1, 1, 64}, {{0, 2, 2 + 0x1p-20, -2, -2}});
    check_state(off.discs()[0], 1 + 0x1p-20, 1, 2, -2, 1);
}

TEST_CASE("a slow disc inside the band bounces at the end without touching") {
    const TimeSteppedReference run = after(1, {16, 1, 1, 64}, {{0, 1 + 0x1p-28, 8, -0x1p-40, 0}});
    CHECK(run.log()[0] == Collision{0, 1.0, 0, Collision::wall});
    check_state(run.discs()[0], 1 + 0x1p-28 - 0x1p-40, 8, 0x1p-40, 0, 1);
    CHECK(after(1, {16, 1, 1, 64}, {{0, 1 + 0x1p-24, 8, -0x1p-40, 0}}).log().empty());
}

TEST_CASE("walls come before pairs at the same time and disc") {
    // At t = 1/2 disc 0 touches the wall and disc 1 touches disc 0. (1/2, 0, wall) comes first and
    // takes disc 0.
    const std::vector<InputDisc> discs = {{0, 2, 8, -2, 0}, {1, 4.5, 8, -3, 0}};
    const TimeSteppedReference run = after(1, {16, 1, 1, 64}, discs);
    REQUIRE(run.log().size() == 1);
    CHECK(run.log()[0] == Collision{0, 0.5, 0, Collision::wall});
    CHECK(run.counters() == Counters{2, 1, 1, 0});
    // The contact was at 1/2 of micro-step 0. The next prediction starts from tau = 1/2: touching,
    // approaching, t = -1/2.
    const TimeSteppedReference later = after(2, {16, 1, 1, 64}, discs);
    CHECK(later.counters().pair_collisions == 0);
}

TEST_CASE("the lower id wins a tie, whatever the place in the list") {
    // Three discs in a row; both gaps close at t = 1/2.
    const std::vector<InputDisc> in_order = {{0, 4, 8, 1, 0}, {1, 6.5, 8, 0, 0}, {2, 9, 8, -1, 0}};
    CHECK(after(1, {16, 1, 1, 64}, in_order).log()[0] == Collision{0, 0.5, 0, 1});
    const std::vector<InputDisc> reversed = {{2, 4, 8, 1, 0}, {1, 6.5, 8, 0, 0}, {0, 9, 8, -1, 0}};
    const TimeSteppedReference run = after(1, {16, 1, 1, 64}, reversed);
    CHECK(run.log()[0] == Collision{0, 0.5, 0, 1});
    CHECK(run.counters() == Counters{2, 1, 0, 1});
    // The rejected pair passes through each other: in the next micro-step its contact is in the
    // past.
    CHECK(after(2, {16, 1, 1, 64}, reversed).counters().pair_collisions == 1);
}

TEST_CASE("deep overlaps pass through, touching pairs collide at once") {
    CHECK(after(4, {16, 1, 1, 64}, {{0, 6, 8, 1, 0}, {1, 7.5, 8, -1, 0}}).log().empty());
    CHECK(after(1, {16, 1, 1, 64}, {{0, 6, 8, 1, 0}, {1, 8, 8, -1, 0}}).log()[0] ==
          Collision{0, 0.0, 0, 1});
    CHECK(after(1, {16, 1, 1, 64}, {{0, 6, 8, 1, 0}, {1, 8 - 0x1p-40, 8, -1, 0}}).log()[0] ==
          Collision{0, 0.0, 0, 1});
    CHECK(after(1, {16, 1, 1, 64}, {{0, 6, 8, 1, 0}, {1, 8 - 0x1p-38, 8, -1, 0}}).log().empty());
    CHECK(after(1, {16, 1, 1, 64}, {{0, 6, 8, 1, 0}, {1, 6, 8, -1, 0}}).log().empty());
}

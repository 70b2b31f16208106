// SPDX-License-Identifier: BSD-3-Clause
// The choice of windows from numbers alone, without discs.
#include "event_driven/window_policy.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"

using namespace carrom;

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// 2000 discs of radius 1 in a box of 100 at this time, with a speed bound of 0.1.
BlockNeeds needs_at(double time) {
    BlockNeeds needs;
    needs.box = 100;
    needs.radius = needs.equivalent_radius = 1;
    needs.n_discs = 2000;
    needs.speed_bound = 0.1;
    needs.time = time;
    return needs;
}

/// The ends of the windows from `time` to `target`, if discs collide at this rate.
std::vector<double> ends_until(double target, WindowPolicy& policy, double rate) {
    std::vector<double> ends;
    for (double time = 0; time < target; time = ends.back()) {
        ends.push_back(policy.plan(needs_at(time), rate, endless, target).end);
        policy.record_end(ends.back() - time);
    }
    return ends;
}

} // namespace

TEST_CASE("window policy: windows of a wanted duration share the time to a sync evenly") {
    WindowPolicy policy({.duration = 0.3});
    const std::vector<double> ends = ends_until(1, policy, 0.2);
    REQUIRE(ends.size() == 4); // windows of a length of at most 0.3
    CHECK(ends[0] == 0.25);
    CHECK(ends[1] == Approx(0.5).epsilon(1e-15));
    CHECK(ends[2] == Approx(0.75).epsilon(1e-15));
    CHECK(ends[3] == 1); // exactly at the target
}

TEST_CASE("window policy: a window ends behind its begin, and never behind the target") {
    WindowPolicy policy({.duration = 1e-30});
    const double begin = 7, next = std::nextafter(begin, 8.0);
    CHECK(policy.plan(needs_at(begin), 0.2, endless, 8).end == next);
    CHECK(policy.plan(needs_at(begin), 0.2, endless, next).end == next);
    WindowPolicy chosen({});
    CHECK(chosen.plan(needs_at(begin), 0.2, endless, next).end == next);
}

TEST_CASE("window policy: no window is longer than the box permits") {
    WindowPolicy policy({});
    const double free = policy.plan(needs_at(0), 1e-3, endless, 1e6).choice.duration;
    WindowPolicy bounded({});
    const PlannedWindow window = bounded.plan(needs_at(0), 1e-3, free / 3, 1e6);
    CHECK(window.choice.duration <= free / 3);
    CHECK(window.end <= free / 3 * (1 + 1e-8));
}

TEST_CASE("window policy: the speed bound falls by a hundredth a window, and rises at once") {
    const WindowPolicy policy({.speed_allowance = 1.5});
    CHECK(policy.speed_bound(2, 0, 0) == 3);        // 1.5 times the largest speed
    CHECK(policy.speed_bound(2, 2.5, 0) == 3);      // the largest speed has grown
    CHECK(policy.speed_bound(1, 4, 0) == 0.99 * 4); // the largest speed has become smaller
    CHECK(policy.speed_bound(2, 0, 0.25) == 3.25);  // the frame falls
}

TEST_CASE("window policy: speeds count until twice the last window, or to the target") {
    WindowPolicy policy({});
    CHECK(policy.soon(10, 100) == 12); // before the first window its length counts as 1
    policy.record_end(4);
    CHECK(policy.soon(10, 100) == 18);
    CHECK(policy.soon(10, 15) == 15);
}

TEST_CASE("window policy: a rate that falls shortens no window by more than it would at once") {
    // Windows for a collision rate of 0.01 are longer than those for a rate of 1. The rate that is
    // used is at least 0.9 times the last one, so windows become longer step by step.
    const auto duration = [](WindowPolicy& policy, double rate) {
        const double chosen = policy.plan(needs_at(0), rate, endless, 1e6).choice.duration;
        policy.record_end(chosen);
        return chosen;
    };
    WindowPolicy at_once({}), slowly({}), by_nine_tenths({});
    const double last = duration(at_once, 0.01), first = duration(slowly, 1);
    REQUIRE(last > 1.5 * first);
    CHECK(duration(slowly, 0.01) == duration(by_nine_tenths, 0.9));
    CHECK(slowly.collision_rate() == 0.01); // the measured rate
    double now = first;
    for (int k = 0; k < 60; ++k) { // 0.9^44 is 0.0097
        const double longer = duration(slowly, 0.01);
        CHECK(longer >= now);
        now = longer;
    }
    CHECK(now == last);
}

TEST_CASE("window policy: repeated runs deepen the halo of later windows, not a wanted one") {
    for (const bool is_wanted : {false, true}) {
        WindowSetting setting;
        if (is_wanted) setting.halo = 3;
        WindowPolicy policy(setting), calm(setting);
        const auto halo = [](WindowPolicy& one) {
            const PlannedWindow window = one.plan(needs_at(0), 0.2, endless, 64);
            one.record_end(window.end);
            return window.choice.halo;
        };
        const int before = halo(policy);
        for (int k = 0; k < 20; ++k) {
            policy.note({.repeated = 0.2, .waited = 0.3, .price_of_reach = 0.1});
            policy.note({.repeated = 0.1, .waited = 0.3, .price_of_reach = 0.1});
            halo(policy);
            halo(calm);
        }
        CHECK(halo(policy) == before + (is_wanted ? 0 : 2));
        CHECK(halo(calm) == before);
    }
}

TEST_CASE("window policy: windows become shorter where almost all runs are repeated") {
    WindowPolicy policy({}), calm({});
    double length = 0, calm_length = 0;
    for (int k = 0; k < 60; ++k) {
        length = policy.plan(needs_at(0), 1, endless, 64).choice.duration;
        policy.record_end(length);
        policy.note({.repeated = 1, .waited = 0, .price_of_reach = 0.1});
        calm_length = calm.plan(needs_at(0), 1, endless, 64).choice.duration;
        calm.record_end(calm_length);
    }
    CHECK(length < 0.5 * calm_length);
    CHECK(length >= 0.1); // at least a tenth of a collision per disc
}

TEST_CASE("window policy: a window for a higher speed keeps its reach") {
    const BlockWindow window{2, 6, false, 0.5};
    const BlockWindow faster = shortened(window, 2, 1);
    CHECK(faster.begin == 2);
    CHECK(faster.end == 3); // at four times the speed a quarter of the length
    CHECK(faster.speed_bound == 2);
    CHECK_FALSE(faster.holds_begin);
    const BlockWindow from_rest = shortened({2, 6, false, 0}, 2, 1);
    CHECK(from_rest.end == 2.5); // the time of a flight over a diameter
    CHECK(shortened({2, 6, false, 0x1p-100}, 0x1p800, 1).end == std::nextafter(2.0, 6.0));
}

// SPDX-License-Identifier: BSD-3-Clause
// The contact predicate compared with quad precision, with the bounds of
// docs/understanding/method.md, section 4.2, in the hardest cases.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "verdict.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

double by_ulps(double value, int ulps) {
    for (int i = 0; i < std::abs(ulps); ++i)
        value = std::nextafter(value, ulps < 0 ? -1e300 : 1e300);
    return value;
}

} // namespace

TEST_CASE("contact times are as accurate as promised") {
    Approaches approaches(11);
    Worst worst;
    for (int i = 0; i < 200000; ++i) worst.take(judge(approaches.any()));
    worst.check(100000);
}

TEST_CASE("contact times are as accurate as promised near a graze at any distance") {
    // Far away, one ulp of a velocity moves the line of flight by more than the margin. So
    // neighbouring velocities are tried, too.
    Approaches approaches(12);
    Worst worst;
    for (int i = 0; i < 1500; ++i) {
        const Approach start = approaches.make(approaches.log_uniform(1, 1e6), 0,
                                               approaches.log_uniform(0.01, 100), 1);
        Approach nearest = start;
        Quad smallest = std::numeric_limits<double>::max();
        for (int j = 0; j < 169; ++j) {
            Approach trial = start;
            trial.wx = by_ulps(start.wx, j % 13 - 6);
            trial.wy = by_ulps(start.wy, j / 13 - 6);
            const EventContact exact(trial.dx, trial.dy, trial.wx, trial.wy, trial.sigma);
            if (exact.discriminant <= 0 || exact.discriminant / exact.a >= smallest) continue;
            smallest = exact.discriminant / exact.a;
            nearest = trial;
        }
        worst.take(judge(nearest));
    }
    worst.check(100);
}

TEST_CASE("touching pairs collide at once if they approach") {
    Approaches approaches(13);
    for (int i = 0; i < 20000; ++i) {
        const int ulps = approaches.whole(-40, 40);
        const Approach c = approaches.make(1 + ulps * 0x1p-52, approaches.log_uniform(1e-9, 1), 1,
                                           approaches.uniform(0.5, 2));
        const double delay = delay_of(c);
        CHECK(delay >= 0);
        CHECK(delay <= 1e-9);
        if (std::sqrt(c.dx * c.dx + c.dy * c.dy) <= c.sigma) CHECK(delay == 0);
        CHECK(contact_delay(c.dx, c.dy, -c.wx, -c.wy, c.sigma, deepest) < 0);
    }
}

TEST_CASE("overlaps collide down to the tolerance and no further") {
    const double sigma = 2, tolerance = 1e-12;
    CHECK(contact_delay(sigma - 0.9e-12, 0.0, -1.0, 0.0, sigma, tolerance) == 0);
    CHECK(contact_delay(sigma - 1.1e-12, 0.0, -1.0, 0.0, sigma, tolerance) < 0);
    CHECK(contact_delay(0.5, 0.5, -1.0, 0.0, sigma, tolerance) < 0);
    CHECK(contact_delay(0.5, 0.5, -1.0, 0.0, sigma, std::numeric_limits<double>::infinity()) == 0);
    CHECK(contact_delay(0.0, 0.0, -1.0, 0.0, sigma, std::numeric_limits<double>::infinity()) < 0);
}

TEST_CASE("contacts of exact numbers are exact") {
    CHECK(contact_delay(4.0, 0.0, -0.5, 0.0, 2.0, 0.0) == 4);
    CHECK(contact_delay(0.0, -10.0, 0.0, 4.0, 2.0, 0.0) == 2);
    CHECK(contact_delay(5.0, 3.0, -1.0, 0.0, 5.0, 0.0) ==
          Approx(1).epsilon(1e-15));                         // 3-4-5 triangle: contact at (4, 3)
    CHECK(contact_delay(4.0, 2.0, -1.0, 0.0, 2.0, 0.0) < 0); // an exact graze
    CHECK(contact_delay(4.0, 3.0, -1.0, 0.0, 2.0, 0.0) < 0);
    CHECK(contact_delay(4.0, 0.0, 0.5, 0.0, 2.0, 0.0) < 0);
}

TEST_CASE("equal velocities never meet, at any distance") {
    Approaches approaches(14);
    for (int i = 0; i < 1000; ++i) {
        const Approach c = approaches.any();
        CHECK(contact_delay(c.dx, c.dy, 0.0, 0.0, c.sigma, deepest) < 0);
        CHECK(contact_delay(c.dx, c.dy, -0.0, 0.0, c.sigma, deepest) < 0);
        CHECK(contact_delay(0.0, 0.0, 0.0, 0.0, c.sigma, deepest) < 0);
    }
}

TEST_CASE("denormal and tiny velocities give no contact or a true one, never a NaN") {
    Approaches approaches(15);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const double speed = approaches.log_uniform(1e-308, 1e-3) * (i % 4 == 0 ? 1e-12 : 1);
        const double distance = i % 2 == 0 ? 1 + approaches.whole(-3, 3) * 0x1p-53
                                           : approaches.log_uniform(1, 1e6);
        const Approach c = approaches.make(distance, approaches.log_uniform(1e-3, 1), speed, 1);
        const double delay = delay_of(c);
        CHECK(!std::isnan(delay));
        if (delay < 0) {
            CHECK(speed < 1e-140); // here A underflows, so there is no contact
            continue;
        }
        hits += 1;
        const EventContact exact(c.dx, c.dy, c.wx, c.wy, c.sigma);
        CHECK(exact.delay >= 0);
        // Below 1e-140 some of the products are denormal and a delay of 1e140 steps need not be
        // accurate.
        if (speed > 1e-140) CHECK(judge(c).delay_ratio <= 1);
    }
    CHECK(hits > 5000);
}

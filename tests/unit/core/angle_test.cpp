// SPDX-License-Identifier: BSD-3-Clause
// Directions of angles compared with the C library.
#include "catch.hpp"

#include <cmath>
#include <numbers>

#include "core/angle.hpp"

using namespace carrom;

TEST_CASE("angles: directions are those of the C library, to within 2e-15") {
    constexpr int n = 100'000;
    double worst = 0;
    for (int k = -n; k <= n; ++k) {
        const double angle = std::numbers::pi * k / n;
        const Direction along = direction_of(angle);
        worst = std::max(
            {worst, std::fabs(along.x - std::cos(angle)), std::fabs(along.y - std::sin(angle))});
    }
    CHECK(worst < 2e-15);
    CHECK(direction_of(0).x == 1);
    CHECK(direction_of(0).y == 0);
}

TEST_CASE("angles: whole turns are taken off, and the rest is at most half a turn") {
    constexpr double pi = std::numbers::pi;
    CHECK(wrapped_angle(0.5) == 0.5);
    CHECK(wrapped_angle(-pi) == -pi);
    CHECK(wrapped_angle(pi + 1) == Approx(1 - pi));
    CHECK(wrapped_angle(-pi - 1) == Approx(pi - 1));
    CHECK(wrapped_angle(8 * pi + 0.25) == Approx(0.25));
    for (const double angle : {std::nextafter(pi, 4.0), 3 * pi, -5 * pi, 1e9, -1e60})
        CHECK(std::fabs(wrapped_angle(angle)) <= pi);
}

TEST_CASE("angles: random ones fill the circle evenly") {
    double x = 0, y = 0, outside = 0;
    for (DiscId id = 0; id < 10'000; ++id) {
        const double angle = random_angle({1, Purpose::direction, id});
        x += std::cos(angle) / 10'000;
        y += std::sin(angle) / 10'000;
        outside += std::fabs(angle) > std::numbers::pi / 2 ? 1e-4 : 0;
    }
    CHECK(std::hypot(x, y) < 0.03);
    CHECK(outside == Approx(0.5).margin(0.02));
}

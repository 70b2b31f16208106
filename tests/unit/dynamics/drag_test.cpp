// SPDX-License-Identifier: BSD-3-Clause
// Drag compared with the C library's exponential. Also numbers that no scene contains, for which
// the computation must end.
#include <cmath>
#include <limits>

#include "catch.hpp"

#include "dynamics/drag.hpp"

using namespace carrom;

TEST_CASE("drag is an exponential over the whole range of doubles") {
    for (const double z : {0.0, 1e-300, 1e-9, 0.3, 0.5, 0.500001, 1.0, 7.3, 50.0, 700.0}) {
        CAPTURE(z);
        CHECK(drag_slowing(z, 1) == Approx(std::exp(-z)).epsilon(1e-12));
        CHECK(drag_slowing(1, z) == drag_slowing(z, 1));
        CHECK(drag_clock(1, z) == Approx(-std::expm1(-z)).epsilon(1e-14));
    }
    CHECK(drag_slowing(1e308, 1e308) == 0);
    CHECK(drag_slowing(1, 1e5) == 0);
    CHECK(drag_clock(1, 1e5) == Approx(1).epsilon(1e-14));
}

TEST_CASE("drag comes to an end for what is no number") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                     infinity = std::numeric_limits<double>::infinity();
    for (const double rate : {1.0, nan, infinity})
        for (const double time : {1.0, nan, infinity}) {
            if (rate == 1 && time == 1) continue;
            CAPTURE(rate);
            CAPTURE(time);
            CHECK(!(drag_slowing(rate, time) > 0));
            CHECK(!(drag_clock(rate, time) > 1e308));
        }
}

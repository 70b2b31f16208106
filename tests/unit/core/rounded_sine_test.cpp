// SPDX-License-Identifier: BSD-3-Clause
// The sine of the legacy generator, compared with Taylor's series in quadruple precision.
#include "catch.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "core/rounded_sine.hpp"
#include "quad.hpp"

using namespace carrom;

namespace {

int differences(double angle) {
    const RoundedSine ours = rounded_sine(angle);
    return (ours.sine != test::nearest_sine(angle)) + (ours.cosine != test::nearest_cosine(angle));
}

} // namespace

TEST_CASE("rounded sine: every value is the nearest double") {
    int n_different = 0;
    std::mt19937_64 random(7);
    for (int k = 0; k < 20000; ++k)
        n_different += differences(std::ldexp(static_cast<double>(random() >> 11), -53) * 14 - 7);
    CHECK(n_different == 0);
}

TEST_CASE("rounded sine: angles near multiples of a quarter of pi") {
    int n_different = 0;
    for (int k = -8; k <= 8; ++k) {
        double low = k * std::numbers::pi / 4, high = low;
        for (int step = 0; step < 20; ++step) {
            n_different += differences(low) + differences(high);
            low = std::nextafter(low, -8.0);
            high = std::nextafter(high, 8.0);
        }
    }
    CHECK(n_different == 0);
    CHECK(rounded_sine(0).sine == 0);
    CHECK(rounded_sine(0).cosine == 1);
}

// SPDX-License-Identifier: BSD-3-Clause
// The virial of many collisions at once, compared with a separate 128-bit integer for each term.
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "engine/stress_sums.hpp"

using namespace carrom;

namespace {

struct Impulse {
    double x = 0, y = 0;
    Separation to;
};

/// Sizes are spread evenly over the powers of two from `least` to `most`.
std::vector<Impulse> impulses(std::size_t count, int least, int most, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const auto number = [&] { return static_cast<double>(engine() >> 11) * 0x1p-52 - 1; };
    std::vector<Impulse> all(count);
    for (Impulse& impulse : all) {
        const int size = least + static_cast<int>(engine() % static_cast<unsigned>(most - least));
        impulse = {std::ldexp(number(), size), std::ldexp(number(), size), {number(), number()}};
    }
    return all;
}

StressSums virial_of(const std::vector<Impulse>& impulses, double bound, std::size_t split) {
    StressSums sum(bound), rest(bound);
    StressTerms terms;
    for (std::size_t k = 0; k < impulses.size(); ++k) {
        if (k == split) terms.add_to(sum);
        terms.add(impulses[k].x, impulses[k].y, impulses[k].to, k < split ? sum : rest);
    }
    terms.add_to(rest);
    return sum += rest;
}

std::array<double, 3> values_of(const StressSums& virial) {
    return {virial.xx.value(), virial.xy.value(), virial.yy.value()};
}

/// The expected sums: terms rounded to the nearest unit, and added as whole numbers with more bits
/// than StressSums has.
std::array<double, 3> expected_of(const std::vector<Impulse>& impulses, double bound) {
    const double unit = std::ldexp(bound, -125);
    std::array<long double, 3> sums{};
    for (const Impulse& i : impulses) {
        const std::array<double, 3> terms = {-i.x * i.to.x, -0.5 * (i.x * i.to.y + i.y * i.to.x),
                                             -i.y * i.to.y};
        for (std::size_t k = 0; k < 3; ++k)
            sums[k] += std::nearbyint(static_cast<long double>(terms[k]) / unit);
    }
    std::array<double, 3> values{};
    for (std::size_t k = 0; k < 3; ++k) values[k] = static_cast<double>(sums[k] * unit);
    return values;
}

} // namespace

TEST_CASE("virials have the same bits in any order and any split") {
    const double bound = 0x1p79; // a unit of 2^-45
    // all in vectors; some terms separately; most terms separately
    for (const int largest : {1, 5, 40}) {
        std::vector<Impulse> all = impulses(1000, -10, largest, 5);
        const std::array<double, 3> expected = values_of(virial_of(all, bound, 0));
        std::mt19937_64 engine(6);
        for (int trial = 0; trial < 20; ++trial) {
            std::shuffle(all.begin(), all.end(), engine);
            CHECK(values_of(virial_of(all, bound, engine() % all.size())) == expected);
        }
    }
}

TEST_CASE("virials are sums of the terms' nearest integers") {
    const double bound = 0x1p79;
    for (const int largest : {-9, 1, 5}) {
        const std::vector<Impulse> all = impulses(501, -10, largest, 7);
        const std::array<double, 3> found = values_of(virial_of(all, bound * 0.75, 250)),
                                    expected = expected_of(all, bound);
        for (std::size_t k = 0; k < 3; ++k) CHECK(found[k] == expected[k]);
    }
}

TEST_CASE("virials of tiny and of huge units") {
    for (const double bound : {0x1p-1000, 0x1p1000}) {
        const int size = static_cast<int>(std::log2(bound)) - 30;
        const std::vector<Impulse> all = impulses(300, size, size + 20, 8);
        double expected = 0, magnitude = 0;
        for (const Impulse& i : all) {
            expected -= i.x * i.to.x;
            magnitude += std::fabs(i.x * i.to.x);
        }
        const double found = virial_of(all, bound, 100).xx.value();
        CHECK(std::fabs(found - expected) <= 1e-13 * magnitude);
    }
}

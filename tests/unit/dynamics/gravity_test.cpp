// SPDX-License-Identifier: BSD-3-Clause
// Falling with drag, compared with series in long double and with the path of a body.
#include <algorithm>
#include <array>
#include <cmath>

#include "catch.hpp"

#include "dynamics/drag.hpp"
#include "dynamics/falling_frame.hpp"
#include "numbers_of_any_size.hpp"

using namespace carrom;
using test::Numbers;

namespace {

using Long = long double;

/// (-log(1 - q) - q) / c^2 = s^2 (1/2 + q/3 + q^2/4 + ...), q = c s.
Long fall_of(double rate, double clock) {
    const Long q = Long(rate) * clock;
    Long sum = 0, power = 1;
    for (int k = 2; power > 1e-22L; ++k, power *= q) sum += power / k;
    return Long(clock) * clock * sum;
}

struct Flight {
    double distance, velocity, pull, rate;

    double height(double s) const {
        return static_cast<double>(distance + Long(velocity) * s + Long(pull) * fall_of(rate, s));
    }
    double contact() const { return dragged_fall_delay(distance, velocity, pull, rate); }
    double rounding(double s) const {
        return 16 * 0x1p-53 *
               (std::fabs(distance) + std::fabs(velocity) * s +
                std::fabs(pull) * static_cast<double>(fall_of(rate, s)));
    }
    double least_height(double until, int n) const {
        double least = height(0);
        for (int k = 0; k < n; ++k) least = std::min(least, height(until * k / n));
        return least;
    }
};

} // namespace

TEST_CASE("fall: how far drag lets fall is right to some ulp") {
    double worst = 0;
    for (const double rate : {1e-9, 1e-3, 0.02, 0.0625, 0.5}) {
        for (double q = 1e-7; q < 0.985; q = std::min(1.25 * q, q + 0.0101)) {
            const double clock = q / rate;
            worst = std::max(worst, std::fabs(static_cast<double>(
                                        dragged_fall(rate, clock) / fall_of(rate, clock) - 1)));
        }
    }
    // the rounding of c s is multiplied by 1 / (1 - c s), which is at most 60
    CHECK(worst < 160 * 0x1p-53);
    CHECK(dragged_fall(0.1, 0) == 0);
    CHECK(dragged_fall(1e-300, 3) == 4.5);
}

TEST_CASE("fall: with drag, too, time since a rest is made of what fell and what the clock shows") {
    for (const double rate : {1e-3, 0.02, 0.05}) { // t = s + c F(s)
        for (int n = 1; n <= 64; ++n) {
            const double s = drag_clock(rate, n);
            CHECK(s + rate * dragged_fall(rate, s) == Approx(n).epsilon(2e-14));
        }
    }
}

TEST_CASE("fall: a contact with drag is at the wall, and nothing comes before") {
    Numbers random(20262);
    int n_hits = 0, n_misses = 0;
    for (int k = 0; k < 3000; ++k) {
        Flight flight{std::exp2(random.uniform(-30, 6)),
                      std::exp2(random.uniform(-12, 3)) * (k % 2 == 0 ? 1 : -1),
                      std::exp2(random.uniform(-12, 2)), 0};
        if (k % 4 < 3)
            flight.pull = -flight.pull;
        else if (k % 8 == 3)
            flight.pull = flight.velocity * flight.velocity / (2 * flight.distance) *
                          random.uniform(0.5, 1.1); // near a graze
        flight.rate = std::exp2(random.uniform(-14, 3)) * std::fabs(flight.pull / flight.velocity);
        const double found = flight.contact(), latest = 0.99 / flight.rate;
        const bool is_hit = std::isfinite(found);
        (is_hit ? n_hits : n_misses) += 1;
        const double until = is_hit ? found : latest;
        INFO("case " << k << ", contact " << found << " of " << latest);
        CHECK(flight.least_height(until, 60) > -flight.rounding(until));
        if (is_hit) CHECK(std::fabs(flight.height(found)) <= flight.rounding(found));
    }
    CHECK(n_hits > 1500);
    CHECK(n_misses > 500);
}

TEST_CASE("fall: a disc that has just left a wall comes back after a flight, however small") {
    Numbers random(20262);
    for (int k = 0; k < 1000; ++k) {
        const double speed = std::exp2(random.uniform(-40, 2)),
                     pull = std::exp2(random.uniform(-10, 2)),
                     rate = std::exp2(random.uniform(-14, -2));
        // From the last distance the disc never comes back to the wall.
        for (const double beyond : {0.0, -1e-3 * speed * speed / pull, -speed * speed / pull}) {
            const Flight flight{beyond, speed, -pull, rate};
            const double found = flight.contact();
            INFO("case " << k << ", from " << beyond);
            if (!std::isfinite(found)) {
                CHECK(flight.height(0.99 / rate) > 0);
                continue;
            }
            CHECK(found > 0);
            if (beyond < -0.6 * speed * speed / pull)
                CHECK(found ==
                      Approx(speed / (pull + rate * speed)).epsilon(1e-14)); // the body turns there
            else
                CHECK(std::fabs(flight.height(found)) <= flight.rounding(found));
        }
    }
}

TEST_CASE("fall: touching counts while the distance falls, less and less drag is none") {
    CHECK(dragged_fall_delay(0, -0.5, -1, 0.1) == 0);
    CHECK(dragged_fall_delay(-1e-17, -1e-9, 1, 0.1) == 0);
    CHECK(dragged_fall_delay(0, 0.5, 1, 0.1) == INFINITY);
    CHECK(dragged_fall_delay(0, 0, 1, 0.1) == INFINITY);
    CHECK(dragged_fall_delay(1, 0, 0, 0.1) == INFINITY);
    CHECK(dragged_fall_delay(1, -0.5, 0, 0.1) == 2);
    // pulled away before it reaches the wall
    CHECK(dragged_fall_delay(1, -0.5, 0.2, 0.1) == INFINITY);
    CHECK(dragged_fall_delay(1e9, 0, -1, 0.5) ==
          INFINITY); // it would arrive when its first velocity has decayed
    for (const auto& [distance, velocity, pull] :
         {std::array{2.0, -0.5, -0.1}, {2.0, 0.5, -0.1}, {0.0, 0.5, -0.1}, {2.0, -0.8, 0.1}})
        CHECK(dragged_fall_delay(distance, velocity, pull, 1e-15) ==
              Approx(fall_delay(distance, velocity, pull)).epsilon(1e-13));
}

TEST_CASE("fall: lengths and times scaled by powers of two give scaled bits") {
    Numbers random(20262);
    for (int k = 0; k < 300; ++k) {
        const double distance = random.uniform(0, 8), velocity = random.uniform(-2, 2),
                     pull = random.uniform(-1, 1), rate = random.uniform(0.01, 0.3);
        const double found = dragged_fall_delay(distance, velocity, pull, rate);
        for (const double length : {0x1p-60, 0x1p80}) {
            const double time = 0x1p10;
            CHECK(dragged_fall_delay(distance * length, velocity * length / time,
                                     pull * length / (time * time), rate / time) == found * time);
        }
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Gravity that changes in time: its frame, contacts with walls, and integrals over flights. All are
// compared with closed forms, dense searches and sums in long double, without series and brackets.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "catch.hpp"

#include "dynamics/effects.hpp"
#include "dynamics/falling_frame.hpp"
#include "dynamics/sway.hpp"
#include "numbers_of_any_size.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

using Long = long double;
constexpr Long turn = 2 * std::numbers::pi_v<Long>;

Acceleration random_gravity(Numbers& random) {
    Acceleration gravity;
    gravity.x = random.uniform(-1, 1), gravity.y = random.uniform(-1, 1);
    gravity.amplitude_x = random.of_any_size(1e-3, 10);
    gravity.amplitude_y = random.of_any_size(1e-3, 10);
    gravity.period = random.of_any_size(1, 1000);
    gravity.phase_x = random.uniform(-7, 7), gravity.phase_y = random.uniform(-7, 7);
    return gravity;
}

/// A disc near a wall, at `time` after the sync. Towards the inside is positive.
struct Flight {
    Acceleration gravity;
    double distance = 0, rate = 0, pull = 0, sign = 1, sync = 0, time = 0;

    Long phase(Long s) const {
        return turn * (Long(sync) + Long(time) + s) / gravity.period + gravity.phase_y;
    }
    Long gap(Long s) const {
        const Long w = turn / gravity.period, a = Long(sign) * gravity.amplitude_y;
        const Long swayed = (a / w) * std::cos(phase(0)) * s -
                            a / (w * w) * (std::sin(phase(s)) - std::sin(phase(0)));
        return Long(distance) + Long(rate) * s + Long(pull) / 2 * s * s + swayed;
    }
    double contact() const {
        Sway sway(gravity);
        sway.begin_interval(sync);
        return sway.contact_delay(1, sign, distance, rate, pull, time);
    }
    Long end() const { return Long(gravity.period) / 8 - time; }
};

/// The first root after which the gap is negative, with steps of a thousandth.
Long first_root(const Flight& flight, Long& least) {
    const Long step = flight.end() / 2000;
    least = std::numeric_limits<Long>::infinity();
    for (Long s = 0; s < flight.end(); s += step) {
        least = std::min(least, flight.gap(s + step));
        if (flight.gap(s + step) >= 0) continue;
        Long above = s, below = s + step;
        for (int k = 0; k < 80; ++k) {
            const Long middle = (above + below) / 2;
            (flight.gap(middle) > 0 ? above : below) = middle;
        }
        return above;
    }
    return std::numeric_limits<Long>::infinity();
}

Flight random_flight(Numbers& random) {
    Flight flight;
    flight.gravity = random_gravity(random);
    flight.sign = random.index(2) == 0 ? 1 : -1;
    flight.pull = flight.sign * flight.gravity.y;
    flight.sync = random.index(1000);
    flight.time = random.uniform(0, 0.1) * flight.gravity.period;
    const double t = static_cast<double>(flight.end()),
                 way = (std::fabs(flight.pull) + flight.gravity.amplitude_y) * t * t / 2;
    flight.distance = way * random.of_any_size(1e-4, 1);
    flight.rate = way / t * random.of_any_size(1e-2, 2) * (random.index(3) == 0 ? 1 : -1);
    if (random.index(8) == 0) flight.rate = 0;
    return flight;
}

} // namespace

TEST_CASE("sway: a frame at rest at a sync falls by the double integral of a sine") {
    Numbers random(61);
    for (int k = 0; k < 2000; ++k) {
        const Acceleration g = random_gravity(random);
        const double sync = random.index(5000), time = random.uniform(0, 0.125) * g.period;
        Sway sway(g);
        sway.begin_interval(sync);
        const Swayed y = sway.at(1, time);
        const Long w = turn / g.period, a = g.amplitude_y, first = w * Long(sync) + g.phase_y,
                   last = first + w * time;
        const Long speed = a / w * (std::cos(first) - std::cos(last)),
                   way = a / w * std::cos(first) * time -
                         a / (w * w) * (std::sin(last) - std::sin(first));
        // Phases have the rounding error of the number of turns since the start.
        const Long blur = 0x1p-50 * (1 + Long(sync) / g.period + std::fabs(g.phase_y));
        CHECK(std::fabs(y.speed - speed) <= blur * a * time);
        // The reference subtracts nearly equal numbers, computed from rounded phases.
        const Long of_reference = 0x1p-61L * (1 + std::fabs(first)) * a / (w * w);
        CHECK(std::fabs(y.way - way) <= blur * a * time * time + of_reference);
        CHECK(std::fabs(y.acceleration - a * std::sin(last)) <= 4 * blur * a);
        const auto between = Sway::between(g, sync, sync + 3 * g.period + time);
        CHECK(std::fabs(between[1].speed - speed) <= 8 * blur * a * g.period);
    }
}

TEST_CASE("sway: contacts with walls are the first roots, and none is missed") {
    Numbers random(62);
    int n_contacts = 0, n_free = 0;
    for (int k = 0; k < 3000; ++k) {
        const Flight flight = random_flight(random);
        Long least = 0;
        const Long expected = first_root(flight, least);
        const double found = flight.contact();
        const Long size = std::fabs(Long(flight.distance)) +
                          std::fabs(Long(flight.rate)) * flight.end() +
                          (std::fabs(Long(flight.pull)) + flight.gravity.amplitude_y) *
                              flight.end() * flight.end();
        const Long blur = 0x1p-46 * size * (1 + Long(flight.sync) / flight.gravity.period);
        INFO("case " << k << ": " << found << ", by search " << static_cast<double>(expected));
        if (std::isfinite(static_cast<double>(expected))) {
            ++n_contacts;
            REQUIRE(std::isfinite(found));
            CHECK(std::fabs(flight.gap(found)) <= blur);
            CHECK(found <= expected + flight.end() * 1e-3L);
        } else if (std::isfinite(found) && found <= flight.end()) {
            CHECK(std::fabs(flight.gap(found)) <= blur); // a graze between two steps of the search
        } else {
            ++n_free;
            CHECK(least >= -blur);
        }
    }
    CHECK(n_contacts > 1000);
    CHECK(n_free > 300);
}

TEST_CASE("sway: a disc at a wall leaves it, and comes back when it is pressed") {
    Acceleration g;
    g.amplitude_y = 0.01, g.period = 80;
    Sway sway(g); // the acceleration is upwards for half a period
    CHECK(sway.contact_delay(1, 1, 0, -0.1, 0, 0) == 0); // the disc approaches
    CHECK(sway.contact_delay(1, 1, 0, 0.1, 0, 0) > 10);  // the disc moves away
    CHECK(sway.contact_delay(1, 1, -1e-17, 1e-3, -0.02, 0) > 0.09);
    sway.begin_interval(40); // downwards in the other half
    const double back = sway.contact_delay(1, 1, 0, 1e-3, 0, 0);
    CHECK(back > 0);
    CHECK(back < 10.01);
}

TEST_CASE("sway: integrals of velocities over flights are those of many points") {
    Numbers random(63);
    for (int k = 0; k < 50; ++k) {
        Effects effects;
        effects.gravity = random_gravity(random);
        FallingFrame frame(effects);
        frame.begin_interval(random.index(100));
        const double time = random.uniform(0.01, 0.125) * effects.gravity.period;
        const double vx = random.uniform(-1, 1), vy = random.uniform(-1, 1);
        constexpr int n = 4000;
        Long xx = 0, xy = 0, yy = 0;
        for (int i = 0; i < n; ++i) {
            const Frame then = frame.at((i + 0.5) / n * time);
            const Long x = vx + then.vx, y = vy + then.vy, weight = Long(time) / n;
            xx += weight * x * x, xy += weight * x * y, yy += weight * y * y;
        }
        const FlightIntegral integral = frame.flight_integral_at(time);
        const double x = vx + integral.shift_x, y = vy + integral.shift_y;
        const auto near = [&](double found, Long expected) {
            return std::fabs(found - expected) <= 1e-6L * (xx + yy);
        };
        CHECK(near(integral.weight * x * x + integral.rest_x * integral.rest_x, xx));
        CHECK(near(integral.weight * x * y + integral.rest_x * integral.rest_y, xy));
        CHECK(near(integral.weight * y * y + integral.rest_y * integral.rest_y +
                       integral.more_y * integral.more_y,
                   yy));
    }
}

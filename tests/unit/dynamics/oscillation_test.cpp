// SPDX-License-Identifier: BSD-3-Clause
// The sine, and the contact of a disc with an oscillating wall, compared with a search in long
// double that samples the distance densely and uses bisection, without derivatives.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "dynamics/oscillation.hpp"
#include "dynamics/sine_series.hpp"
#include "numbers_of_any_size.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

using Long = long double;
constexpr Long long_two_pi = 2 * std::numbers::pi_v<Long>;
constexpr Long none = std::numeric_limits<Long>::infinity();

/// A disc near a wall; `pull` comes from gravity. Towards the inside is positive.
struct Flight {
    double amplitude = 1, period = 1, phase = 0, pull = 0, sign = 1;
    double distance = 0, rate = 0; ///< distance from the wall's line at `time`
    double sync = 0, time = 0;

    Oscillation wall() const {
        const Boundary side{BoundaryKind::oscillating, 1, 0, 0, amplitude, period, phase};
        Oscillation wall(side, sign, sign * pull, slack());
        wall.begin_interval(sync);
        return wall;
    }
    double slack() const { return 8 * 0x1p-52 * (distance + amplitude); }
    double contact() const {
        const Oscillation of_wall = wall();
        return of_wall.contact_delay(distance, rate, rate - sign * of_wall.at(time).velocity, time);
    }
    Long turns(Long s) const { return (Long(sync) + time + s) / period; }
    Long from_line(Long s) const { return distance + rate * s + Long(pull) / 2 * s * s; }
    Long gap(Long s) const {
        return from_line(s) - sign * amplitude * std::sin(long_two_pi * turns(s) + phase);
    }
    Long slope(Long s) const {
        return rate + pull * s -
               sign * amplitude * long_two_pi / period * std::cos(long_two_pi * turns(s) + phase);
    }
    /// The rounding error of positions up to then, in double precision.
    Long rounding(Long s) const {
        const Long speed = long_two_pi * amplitude / period;
        return 0x1p-50 * (std::fabs(distance) + amplitude + std::fabs(rate) * s +
                          std::fabs(pull) * s * s + speed * (Long(sync) + time + s));
    }
    /// The last time at which the disc may be in the range of the wall.
    Long last_time() const {
        const Long room = distance - amplitude;
        const Long square = Long(rate) * rate - 2 * pull * room;
        const bool leaves = room > 0 && (pull >= 0 ? rate >= 0 || square < 0 : false);
        if (leaves) return 0;
        if (pull > 0)
            return std::max<Long>(0, (-rate + std::sqrt(std::max<Long>(square, 0))) / pull);
        if (pull < 0)
            return std::max<Long>(0, (rate + std::sqrt(std::max<Long>(square, 0))) / -pull) +
                   2 * period;
        return rate < 0 ? std::max<Long>(0, room / -rate) + 2 * period
                        : (rate > 0 ? std::max<Long>(0, -room / rate) : 2 * Long(period));
    }
};

/// The time of the smallest gap between `from` and `to`, where there is one minimum, by trisection.
Long time_of_least_gap(const Flight& flight, Long from, Long to) {
    for (int k = 0; k < 200; ++k) {
        const Long third = (to - from) / 3;
        if (flight.gap(from + third) < flight.gap(to - third))
            to -= third;
        else
            from += third;
    }
    return (from + to) / 2;
}

Long root_between(const Flight& flight, Long above, Long below) {
    for (int k = 0; k < 200; ++k) {
        const Long middle = (above + below) / 2;
        (flight.gap(middle) > 0 ? above : below) = middle;
    }
    return (above + below) / 2;
}

struct Found {
    Long time = none;
    Long least = none; ///< the smallest gap so far, at local minima
};

/// The first time after `from` at which the gap decreases to 0.
Found search(const Flight& flight, Long from, Long until) {
    const Long step = flight.period / Long{300};
    Found found;
    Long before = from, gap_before = flight.gap(from), gap_two_before = gap_before;
    for (Long s = from + step; s < until + 2 * step; s += step) {
        const Long gap = flight.gap(s);
        if (gap_before <= gap && gap_before <= gap_two_before) {
            const Long least = time_of_least_gap(flight, std::max(from, before - step), s);
            const Long depth = flight.gap(least);
            if (depth < 0) {
                found.time = root_between(flight, std::max(from, before - step), least);
                return found;
            }
            found.least = std::min(found.least, depth);
        }
        if (gap < 0 && gap_before >= 0) {
            found.time = root_between(flight, before, s);
            return found;
        }
        gap_two_before = gap_before;
        gap_before = gap;
        before = s;
    }
    return found;
}

/// A flight that starts at some distance from the wall, or in its range.
Flight random_flight(Numbers& random) {
    Flight flight;
    flight.amplitude = random.of_any_size(1e-3, 10);
    flight.period = random.of_any_size(0.1, 100);
    flight.phase = random.uniform(-7, 7);
    flight.sign = random.index(2) == 0 ? 1 : -1;
    const double speed = 2 * std::numbers::pi * flight.amplitude / flight.period;
    const double pull = speed * 2 * std::numbers::pi / flight.period;
    flight.pull = std::array{0.0, -1.0, -1.0, 1.0}[static_cast<std::size_t>(random.index(4))] *
                  pull * random.of_any_size(0.01, 10);
    flight.rate = (random.index(4) == 0 ? 1 : -1) * speed * random.of_any_size(0.02, 20);
    if (random.index(8) == 0) flight.rate = 0;
    flight.sync = random.index(1000);
    flight.time = random.uniform(0, 64);
    flight.distance = flight.amplitude * (1 + random.of_any_size(1e-3, 3));
    if (random.index(2) == 0) { // in the range of the wall
        const Long wall = flight.sign * flight.amplitude *
                          std::sin(long_two_pi * flight.turns(0) + Long(flight.phase));
        flight.distance = static_cast<double>(wall) +
                          flight.amplitude * random.of_any_size(1e-9, 2);
    }
    return flight;
}

/// Compares the contact with the search; returns whether there is one.
bool hold(const Flight& flight, Long from = 0) {
    const auto contact = static_cast<Long>(flight.contact());
    const Found found = search(flight, from, flight.last_time());
    INFO("amplitude " << flight.amplitude << " period " << flight.period << " phase "
                      << flight.phase << " pull " << flight.pull << " distance " << flight.distance
                      << " rate " << flight.rate << " sign " << flight.sign << " at " << flight.sync
                      << " + " << flight.time);
    INFO("contact " << static_cast<double>(contact) << ", by search "
                    << static_cast<double>(found.time));
    const Long end = std::min({contact, found.time, flight.last_time() + flight.period});
    const Long rounding = flight.rounding(end) + 2 * flight.slack();
    if (contact == none || found.time == none) {
        // Both find none, or one finds a graze that is only as deep as a rounding error.
        if (contact == found.time) return false;
        const Long touch = std::min(contact, found.time);
        const Long depth = flight.gap(time_of_least_gap(flight, touch, touch + flight.period / 8));
        CHECK(std::fabs(depth) < rounding);
        return false;
    }
    CHECK(std::fabs(flight.gap(contact)) <= rounding);
    // The times differ by at most the rounding error over the slope, or there was a graze before.
    const Long slope = std::fabs(flight.slope(found.time));
    const bool is_near = std::fabs(contact - found.time) <=
                         2 * rounding / slope + 0x1p-50 * (flight.time + contact);
    const Long first = std::min(contact, found.time);
    const bool is_graze = std::fabs(flight.gap(time_of_least_gap(
                              flight, first, first + flight.period / 16))) <= rounding;
    CHECK((is_near || is_graze));
    return true;
}

} // namespace

TEST_CASE("oscillation: the sine is that of long double to 2^-52") {
    Numbers random(71);
    Long worst = 0;
    for (int k = 0; k < 200000; ++k) {
        const double turns = k % 2 == 0 ? random.uniform(-2, 2) : random.of_any_size(1e-12, 1e9);
        const Long within = turns - std::floor(Long(turns));
        const auto [sine, cosine] = sine_of_turns(turns);
        worst = std::max({worst, std::fabs(sine - std::sin(long_two_pi * within)),
                          std::fabs(cosine - std::cos(long_two_pi * within))});
    }
    CHECK(worst < 0x1p-52);
    INFO(static_cast<double>(worst / 0x1p-52));
    for (int quarter = -8; quarter <= 8; ++quarter) {
        const auto [sine, cosine] = sine_of_turns(quarter / 4.0);
        const int place = ((quarter % 4) + 4) % 4;
        CHECK(sine == std::array{0, 1, 0, -1}[static_cast<std::size_t>(place)]);
        CHECK(cosine == std::array{1, 0, -1, 0}[static_cast<std::size_t>(place)]);
    }
}

TEST_CASE("oscillation: contacts are those of a dense search, thousands of them") {
    Numbers random(72);
    int n_contacts = 0, n_none = 0;
    for (int k = 0; k < 4000; ++k) {
        Flight flight = random_flight(random);
        if (flight.last_time() > 60 * Long(flight.period)) continue; // the search would take long
        ++(hold(flight) ? n_contacts : n_none);
    }
    CHECK(n_contacts > 1500);
    CHECK(n_none > 200);
}

// The smallest gap is almost 0.
TEST_CASE("oscillation: a graze is a contact from where it is deeper than rounding") {
    Numbers random(73);
    int n_grazes = 0;
    for (int k = 0; k < 1000; ++k) {
        Flight flight = random_flight(random);
        flight.time = 0;
        if (flight.pull == 0 || flight.rate == 0) continue;
        flight.pull = std::fabs(flight.pull); // the disc approaches and leaves again
        flight.rate = -std::fabs(flight.rate);
        const Long until = -2 * flight.rate / flight.pull + 2 * flight.period;
        if (until > 60 * Long(flight.period)) continue;
        // Moves the disc up until it touches nothing, finds the time of the smallest gap, and then
        // moves the disc down by this gap.
        const Long step = flight.period / Long{2000};
        Long least = none, at = 0;
        flight.distance += 4 * flight.amplitude;
        for (Long s = 0; s < until; s += step)
            if (flight.gap(s) < least) least = flight.gap(s), at = s;
        if (at == 0) continue;
        at = time_of_least_gap(flight, at - step, at + step);
        const double touching = flight.distance - static_cast<double>(flight.gap(at));
        const double hair = static_cast<double>(16 * flight.rounding(at)) + 8 * flight.slack();
        if (touching <= 0) continue;
        ++n_grazes;
        flight.distance = touching + hair;
        INFO("least at " << static_cast<double>(at) << " touching " << touching << " hair "
                         << hair);
        CHECK(flight.contact() == std::numeric_limits<double>::infinity());
        flight.distance = touching - hair;
        const double contact = flight.contact();
        CHECK(contact <= static_cast<double>(at));
        CHECK(std::fabs(flight.gap(contact)) <= hair);
    }
    CHECK(n_grazes > 200);
}

// A disc that has just left the wall, with a speed that is small compared with the wall's.
TEST_CASE("oscillation: a disc that the wall has caught is met again when it should be") {
    Numbers random(74);
    int n_again = 0;
    for (int k = 0; k < 2000; ++k) {
        Flight flight = random_flight(random);
        flight.time = 0;
        flight.pull = -std::fabs(flight.pull);
        const Oscillation wall = flight.wall();
        const double speed = wall.largest_speed();
        const double away = speed * random.of_any_size(1e-7, 1e-2);
        flight.distance = flight.sign * wall.at(0).place; // touches the wall, to within rounding
        flight.rate = flight.sign * wall.at(0).velocity + away;
        if (flight.last_time() > 60 * Long(flight.period)) continue;
        // At `start` the disc has left the wall: it has flown for a hundredth of the time in which
        // `pressure`, the largest possible acceleration towards the wall, would stop it relative to
        // the wall.
        const Long pressure = speed * long_two_pi / flight.period - flight.pull;
        const Long start = away / pressure / 100;
        const Long gap = flight.gap(start);
        if (gap < 100 * flight.rounding(start)) continue;
        n_again += hold(flight, start);
    }
    CHECK(n_again > 500);
}

TEST_CASE("oscillation: what touches and comes nearer is met at once") {
    Flight flight;
    flight.period = 10;
    const double speed = 2 * std::numbers::pi / 10;
    flight.rate = speed - 1e-9;
    CHECK(flight.contact() == 0);
    flight.rate = speed + 1e-3; // the disc leaves, and the wall slows down
    CHECK(flight.contact() == std::numeric_limits<double>::infinity());
    flight.pull = -0.01; // the disc falls back
    CHECK(flight.contact() > 5);
    flight.distance = -1e-3; // beyond the wall: the disc must come back first
    CHECK(flight.contact() > 5);
}

// Discs at rest, at the highest position of the wall or far above it.
TEST_CASE("oscillation: a search ends where there is nothing to find") {
    Flight flight;
    flight.distance = 1;
    flight.rate = 0;
    for (const double period : {1e-4, 1.0, 1e9}) {
        flight.period = period;
        CHECK(flight.contact() == std::numeric_limits<double>::infinity());
        flight.distance = 1 - 1e-9;
        CHECK(flight.contact() < period);
        flight.distance = 1;
        flight.rate = -0x1p-250;
        CHECK(flight.contact() == std::numeric_limits<double>::infinity());
        flight.rate = 0;
    }
    flight.distance = 1e6;
    flight.period = 1;
    flight.rate = -1e-4; // reaches the wall after 1e10 periods
    CHECK(flight.contact() == Approx((1e6 - 1) / 1e-4).epsilon(1e-6));
}

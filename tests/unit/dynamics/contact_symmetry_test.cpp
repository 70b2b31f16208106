// SPDX-License-Identifier: BSD-3-Clause
// The predicate must not depend on the names of the axes, the order of the pair and the unit of
// length. It must also equal, bit by bit, the same predicate written a second time.
#include "catch.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "approach.hpp"
#include "core/disc_state.hpp"
#include "dynamics/pair_contact.hpp"
#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

double delay_of(const Approach& c) {
    return contact_delay(c.dx, c.dy, c.wx, c.wy, c.sigma, 1e-12 * c.sigma);
}

Approach scaled(const Approach& c, int exponent) {
    const auto scale = [exponent](double value) { return std::ldexp(value, exponent); };
    return {scale(c.dx), scale(c.dy), scale(c.wx), scale(c.wy), scale(c.sigma)};
}

/// Two discs in a box of 1000 that may or may not meet, each with its own local time.
struct Pair {
    DiscState p, q;
};

Pair some_pair(Approaches& approaches) {
    const Approach c = approaches.any();
    const double base = approaches.uniform(0, 64);
    Pair pair;
    pair.p.id = 3;
    pair.q.id = 8;
    pair.p.vx = approaches.uniform(-1, 1);
    pair.p.vy = approaches.uniform(-1, 1);
    pair.q.vx = pair.p.vx + c.wx;
    pair.q.vy = pair.p.vy + c.wy;
    pair.p.tau = approaches.whole(0, 2) == 0 ? base : approaches.uniform(0, base);
    pair.q.tau = approaches.whole(0, 1) == 0 ? base : approaches.uniform(0, base);
    const double x = approaches.uniform(0, 1000), y = approaches.uniform(0, 1000);
    pair.p.x = x - pair.p.vx * (base - pair.p.tau);
    pair.p.y = y - pair.p.vy * (base - pair.p.tau);
    pair.q.x = x + c.dx - pair.q.vx * (base - pair.q.tau);
    pair.q.y = y + c.dy - pair.q.vy * (base - pair.q.tau);
    return pair;
}

} // namespace

TEST_CASE("transposed, mirrored and exchanged pairs have the same bits") {
    Approaches approaches(21);
    int differences = 0, hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const Approach c = approaches.any();
        const double delay = delay_of(c);
        hits += delay >= 0;
        differences += !same_bits(delay, delay_of({c.dy, c.dx, c.wy, c.wx, c.sigma}));
        differences += !same_bits(delay, delay_of({-c.dx, c.dy, -c.wx, c.wy, c.sigma}));
        differences += !same_bits(delay, delay_of({c.dx, -c.dy, c.wx, -c.wy, c.sigma}));
        differences += !same_bits(delay, delay_of({-c.dx, -c.dy, -c.wx, -c.wy, c.sigma}));
        differences += !same_bits(delay, delay_of({-c.dy, c.dx, -c.wy, c.wx, c.sigma}));
    }
    CHECK(differences == 0);
    CHECK(hits > 50000);
}

TEST_CASE("a pair scaled by a power of two has the same bits") {
    // Below 2^-230 the discriminant of a graze, a product of four such lengths and the margin,
    // would be denormal.
    Approaches approaches(22);
    int differences = 0, hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Approach c = approaches.any();
        const double delay = delay_of(c);
        hits += delay >= 0;
        for (const int exponent : {-230, -100, -1, 1, 77, 250, approaches.whole(-230, 250)}) {
            differences += !same_bits(delay, delay_of(scaled(c, exponent)));
        }
    }
    CHECK(differences == 0);
    CHECK(hits > 10000);
}

TEST_CASE("a pair that does not graze has the same bits even at 2^-250") {
    Approaches approaches(24);
    int differences = 0;
    for (int i = 0; i < 20000; ++i) {
        const Approach c = approaches.make(approaches.log_uniform(1, 1e6),
                                           approaches.uniform(0.01, 1), approaches.uniform(0.5, 8),
                                           1);
        differences += !same_bits(delay_of(c), delay_of(scaled(c, -250)));
    }
    CHECK(differences == 0);
}

TEST_CASE("the predicate and its second wording have the same bits") {
    Approaches approaches(23);
    int differences = 0, hits = 0;
    const double sigma = 1, infinite = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 200000; ++i) {
        const Pair pair = some_pair(approaches);
        for (const double tolerance : {1e-12, infinite}) {
            const PairContact<double> found = pair_contact(pair.p, pair.q, sigma, tolerance);
            const PairContact<double> exchanged = pair_contact(pair.q, pair.p, sigma, tolerance);
            const reference::Contact expected = reference::contact(pair.p, pair.q, sigma,
                                                                   tolerance);
            differences += !same_bits(found.base, expected.base) ||
                           !same_bits(found.delay, expected.delay);
            differences += !same_bits(found.base, exchanged.base) ||
                           !same_bits(found.delay, exchanged.delay);
        }
        hits += pair_contact(pair.p, pair.q, sigma, infinite).exists();
    }
    CHECK(differences == 0);
    CHECK(hits > 50000);
}

TEST_CASE("a local time later than the contact's base moves nothing") {
    // The same two lines of flight, stored at other exact positions along them: the contact is the
    // same, at base + delay.
    const DiscState p{4, 4, 0.5, 0.25, 0, 0}, q{10, 7, -0.25, 0, 0, 1};
    const DiscState p_later{5, 4.5, 0.5, 0.25, 2, 0};
    const PairContact<double> early = pair_contact(p, q, 2.0, 0.0),
                              late = pair_contact(p_later, q, 2.0, 0.0);
    REQUIRE(early.exists());
    CHECK(late.base == 2);
    CHECK(late.base + late.delay == Approx(early.base + early.delay).epsilon(1e-15));
}

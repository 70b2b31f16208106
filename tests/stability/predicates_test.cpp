// SPDX-License-Identifier: BSD-3-Clause
// Family 1, predicates: the contact time of two discs against quadruple precision, a million cases
// a family.
//
// Why hard: the textbook discriminant b^2 - A C subtracts equal numbers and loses 41 % of the
// grazing hits at 1e4 diameters. Sources: Kahan, On the cost of floating-point computation without
// extra-precise arithmetic (2004); Haines, Guenther, Akenine-Moeller, Ray Tracing Gems, chapter 7
// (2019). Bounds (docs/understanding/method.md, section 4.2): error of the time 16 u (|d| + sigma
// sqrt(A sigma^2/disc)) / |w|; relative error of the discriminant 10 u (1 + A sigma^2/disc); no hit
// missed whose disc > 16 u A sigma^2. The table shows errors as shares of these bounds.
#include "catch.hpp"

#include <cmath>
#include <limits>

#include "hold.hpp"
#include "verdict.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr int n_cases = 1000000;

template <class Make>
void judge_family(const char* name, std::uint64_t seed, int fewest_hits, const Make& make) {
    Approaches approaches(seed);
    Worst worst;
    for (int i = 0; i < n_cases; ++i) worst.take(judge(make(approaches)));
    CHECK(worst.hits >= fewest_hits);
    const std::string what = name;
    hold("predicates", what + ": error of the time, share of its bound", "both", worst.delay_ratio,
         1);
    hold("predicates", what + ": error of the discriminant, share of its bound", "both",
         worst.discriminant_ratio, 1);
    hold("predicates", what + ": hits missed in 1e6", "both", worst.missed, 0);
    hold("predicates", what + ": hits invented in 1e6", "both", worst.invented, 0);
}

} // namespace

// The last bits of the line of flight decide about a graze. Margins are 1e-2 to 1e-14 on either
// side of it.
TEST_CASE("predicates: grazing at 1 to 1e6 diameters") {
    judge_family("grazing at 1 to 1e6 sigma", 101, 500000, [](Approaches& some) {
        const double margin = some.log_uniform(1e-14, 1e-2) * (some.whole(0, 3) == 0 ? -1 : 1);
        const double distance = some.log_uniform(1, 1e6), speed = some.log_uniform(0.01, 100),
                     sigma = some.uniform(0.5, 2);
        return some.make(distance, margin, speed, sigma);
    });
}

// For close discs the time is a difference of almost equal lengths: dt ~ ulp / sqrt(2 margin), in
// any precision.
TEST_CASE("predicates: nearly touching") {
    judge_family("nearly touching", 102, 400000, [](Approaches& some) {
        const double distance = 1 + some.log_uniform(0x1p-52, 1e-3),
                     margin = some.log_uniform(1e-14, 1);
        const double speed = some.log_uniform(0.01, 100), sigma = some.uniform(0.5, 2);
        return some.make(distance, margin, speed, sigma);
    });
}

// A = |w|^2 underflows below 1e-154; the bounds hold as long as no product is denormal.
TEST_CASE("predicates: tiny relative speeds") {
    judge_family("relative speeds 1e-140 to 1e-3", 103, 700000, [](Approaches& some) {
        const double distance = some.log_uniform(1, 1e6), margin = some.log_uniform(1e-6, 1),
                     speed = some.log_uniform(1e-140, 1e-3);
        return some.make(distance, margin, speed, 1);
    });
}

TEST_CASE("predicates: huge speeds") {
    judge_family("relative speeds 1e3 to 1e75", 104, 700000, [](Approaches& some) {
        const double distance = some.log_uniform(1, 1e6), margin = some.log_uniform(1e-6, 1),
                     speed = some.log_uniform(1e3, 1e75);
        return some.make(distance, margin, speed, 1);
    });
}

TEST_CASE("predicates: anything") {
    judge_family("anything", 105, 500000, [](Approaches& some) { return some.any(); });
}

// At denormal speeds a contact may be missed, but no wrong time may result: a NaN would break the
// order of events.
TEST_CASE("predicates: denormal relative speeds") {
    Approaches some(106);
    int n_wrong = 0, n_lost = 0;
    for (int i = 0; i < n_cases; ++i) {
        const double distance = some.log_uniform(1, 1e6), margin = some.uniform(0.01, 1);
        Approach c = some.make(distance, margin, 1, 1);
        const double speed = std::ldexp(1.0, -some.whole(460, 1074));
        c.wx *= speed;
        c.wy *= speed;
        const double delay = delay_of(c);
        n_wrong += std::isnan(delay) || (delay >= 0 && delay < 1e120);
        // Missed contacts: only of pairs so slow that they need 2^500 steps for a diameter.
        n_lost += delay < 0 && speed > 0x1p-500;
    }
    hold("predicates", "denormal relative speeds: times made up in 1e6", "both", n_wrong, 0);
    hold("predicates", "denormal relative speeds: hits missed above 2^-500 in 1e6", "both", n_lost,
         0);
}

// A = 0: any division would give a NaN.
TEST_CASE("predicates: equal velocities") {
    Approaches some(107);
    int n_found = 0;
    for (int i = 0; i < n_cases; ++i) {
        const Approach c = some.any();
        const double infinite = std::numeric_limits<double>::infinity();
        n_found += !(
            contact_delay(c.dx, c.dy, 0.0, -0.0, c.sigma, i % 2 == 0 ? infinite : deepest) < 0);
    }
    n_found += !(contact_delay(0.0, 0.0, 0.0, 0.0, 1.0, 1.0) < 0);
    hold("predicates", "equal velocities: contacts in 1e6", "both", n_found, 0);
}

// Velocities are up to the limit of inputs, 2^250; pairs have differences of them.
TEST_CASE("predicates: speeds at the limits of the input") {
    judge_family("speeds of 2^250 in a scene of 2^250", 108, 700000, [](Approaches& some) {
        const double distance = some.log_uniform(1, 1e6), margin = some.log_uniform(1e-6, 1),
                     speed = some.uniform(0.5, 1);
        return some.make(distance, margin, speed, 0x1p229);
    });
}

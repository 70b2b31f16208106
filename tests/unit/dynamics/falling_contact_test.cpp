// SPDX-License-Identifier: BSD-3-Clause
// The first contact of a parabola with a disc, compared with its path in quad precision.
#include <algorithm>
#include <cmath>

#include "catch.hpp"

#include "dynamics/falling_contact.hpp"
#include "numbers_of_any_size.hpp"
#include "quad.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

struct Flight {
    double dx, dy, wx, wy, gx, gy, reach;

    double gap(double s) const {
        const Quad t = s;
        const Quad x = dx + wx * t + Quad(gx) / 2 * t * t, y = dy + wy * t + Quad(gy) / 2 * t * t;
        return static_cast<double>(square_root(x * x + y * y) - Quad(reach));
    }
    bool falls(double s) const { return gap(s) < gap(s * (1 + 1e-9) + 1e-12); }
    double contact() const { return falling_contact(dx, dy, wx, wy, gx, gy, reach); }
    /// A time after which the flight stays out of reach.
    double horizon() const {
        const double g = std::hypot(gx, gy), w = std::hypot(wx, wy), d = std::hypot(dx, dy) + reach;
        return 4 * (w / g + std::sqrt(d / g));
    }
    /// The rounding error of positions and speeds up to a time.
    double rounding(double until) const {
        return 64 * 0x1p-53 *
               (std::hypot(dx, dy) + reach + std::hypot(wx, wy) * until +
                std::hypot(gx, gy) * until * until);
    }
};

/// The smallest gap at `n` times before `until`.
double least_gap(const Flight& flight, double until, int n) {
    double least = flight.gap(0);
    for (int k = 0; k < n; ++k) least = std::min(least, flight.gap(until * k / n));
    return least;
}

} // namespace

TEST_CASE("falling contact: it is on the circle, and nothing comes before") {
    Numbers random(20261);
    int n_hits = 0, n_misses = 0;
    for (int k = 0; k < 4000; ++k) {
        Flight flight{random.uniform(-8, 8),
                      random.uniform(-8, 8),
                      random.uniform(-2, 2),
                      random.uniform(-2, 2),
                      0,
                      0,
                      random.uniform(0.1, 3)};
        const double g = std::exp2(random.uniform(-12, 2)), angle = random.uniform(0, 6.28);
        flight.gx = k % 3 == 0 ? 0 : g * std::cos(angle);
        flight.gy = k % 3 == 0 ? -g : g * std::sin(angle);
        if (k % 2 == 0) { // thrown so that it comes near later
            const double time = random.uniform(0.1, 6);
            flight.wx = (random.uniform(-1, 1) * flight.reach - flight.dx) / time -
                        0.5 * flight.gx * time;
            flight.wy = (random.uniform(-1, 1) * flight.reach - flight.dy) / time -
                        0.5 * flight.gy * time;
        }
        if (flight.gap(0) <= 0) continue;
        const double found = flight.contact();
        const bool is_hit = std::isfinite(found);
        (is_hit ? n_hits : n_misses) += 1;
        const double until = is_hit ? found : flight.horizon();
        INFO("case " << k << ", contact " << found);
        CHECK(least_gap(flight, until, 200) > -flight.rounding(until));
        if (is_hit) CHECK(std::fabs(flight.gap(found)) <= flight.rounding(found));
    }
    CHECK(n_hits > 1500);
    CHECK(n_misses > 500);
}

TEST_CASE("falling contact: a disc that has just been left comes back when its flight says") {
    Numbers random(20261);
    for (int k = 0; k < 2000; ++k) {
        const double angle = random.uniform(0, 6.28), reach = random.uniform(0.5, 2),
                     speed = std::exp2(random.uniform(-20, 1));
        const double nx = std::cos(angle), ny = std::sin(angle);
        Flight flight{reach * nx, reach * ny, speed * nx, speed * ny,
                      0,          -0.01,      reach}; // touches, to within rounding
        const double found = flight.contact();
        const double first = 2 * speed / (0.01 * ny); // the contact if the disc were a plane
        INFO("case " << k << ", speed " << speed << ", height " << ny << ", contact " << found);
        if (!std::isfinite(found)) {
            CHECK(least_gap(flight, flight.horizon(), 400) > -flight.rounding(flight.horizon()));
            continue;
        }
        CHECK(found > 0);
        CHECK(std::fabs(flight.gap(found)) <= flight.rounding(found));
        if (ny > 0.1 && speed < 1e-3)
            CHECK(found == Approx(first).epsilon(0.05 + 20 * flight.rounding(found) /
                                                            (speed * speed / 0.02)));
        CHECK(least_gap(flight, found, 200) > -flight.rounding(found));
    }
}

TEST_CASE("falling contact: touching counts while the distance falls") {
    CHECK(falling_contact(0, 1, 0, -0.5, 0, -1, 1) == 0);
    CHECK(falling_contact(0, 0.9999999999999999, 0, -1e-9, 0, -1, 1) == 0);
    CHECK(falling_contact(0, 1, 0, 0.5, 0, -1, 1) == Approx(1).epsilon(1e-15));
    // starts at rest above, and is pulled away
    CHECK(falling_contact(0, 1, 0, 0, 0, 1, 1) == INFINITY);
    CHECK(falling_contact(0, -1, 0, 0, 0, -1, 1) == INFINITY);
    CHECK(falling_contact(3, 0, 0, 0, 0, -1, 1) == INFINITY); // falls past
    CHECK(falling_contact(0, 5, 0, 0, 0, -2, 1) == Approx(2).epsilon(1e-15));
    CHECK(falling_contact(0, -5, 0, 4, 0, -2, 1) ==
          INFINITY); // reaches the disc with no speed left: a graze
    CHECK(falling_contact(0, -5, 0, 4.5, 0, -2, 1) ==
          Approx((4.5 - std::sqrt(4.25)) / 2).epsilon(1e-15));
}

TEST_CASE("falling contact: lengths and times scaled by powers of two give scaled bits") {
    Numbers random(20261);
    for (int k = 0; k < 500; ++k) {
        const double n[] = {random.uniform(-8, 8),     random.uniform(2, 8),
                            random.uniform(-2, 2),     random.uniform(-2, 2),
                            random.uniform(-0.1, 0.1), random.uniform(-1, -0.1)};
        const double found = falling_contact(n[0], n[1], n[2], n[3], n[4], n[5], 1.5);
        for (const double length : {0x1p-60, 0x1p80}) {
            const double time = 0x1p10;
            const double v = length / time, g = v / time;
            CHECK(falling_contact(n[0] * length, n[1] * length, n[2] * v, n[3] * v, n[4] * g,
                                  n[5] * g, 1.5 * length) == found * time);
        }
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// The predicate of growing discs compared with quad precision, which solves the original quadratic
// in t: |d + w t| = sigma (1 + g t).
#include "catch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "approach.hpp"
#include "dynamics/growing_contact.hpp"
#include "quad.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double u = 0x1p-53;
constexpr double any_overlap = 1e300;

double delay_of(const Approach& c, double g) {
    return growing_contact_delay(c.dx, c.dy, c.wx, c.wy, c.sigma, g, any_overlap);
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// The first time at which c + 2 b t + a t^2 = |d + w t|^2 - sigma^2 (1 + g t)^2 is 0; negative for
/// none.
struct GrowingContact {
    Quad a, b, c, discriminant;
    Quad delay = -1;

    GrowingContact(const Approach& pair, double g) {
        const Quad square = Quad(pair.sigma) * pair.sigma;
        a = Quad(pair.wx) * pair.wx + Quad(pair.wy) * pair.wy - square * g * g;
        b = Quad(pair.dx) * pair.wx + Quad(pair.dy) * pair.wy - square * g;
        c = Quad(pair.dx) * pair.dx + Quad(pair.dy) * pair.dy - square;
        discriminant = b * b - a * c;
        if (c <= 0) {
            if (b < 0) delay = 0;
        } else if (discriminant > 0 && (b < 0 || a < 0)) {
            delay = c / (-b + square_root(discriminant));
        }
    }
};

/// The allowed error of the predicate: that of discs of constant size in coordinates that grow with
/// them, times the square of the growth, because du = dt / (1 + g t)^2.
Quad bound_of(const Approach& pair, double g, const GrowingContact& exact) {
    const Quad wx = pair.wx - Quad(g) * pair.dx, wy = pair.wy - Quad(g) * pair.dy;
    const Quad a = wx * wx + wy * wy, cross = Quad(pair.dx) * wy - Quad(pair.dy) * wx;
    const Quad condition = a * pair.sigma * pair.sigma /
                           (a * pair.sigma * pair.sigma - cross * cross);
    const Quad distance = square_root(Quad(pair.dx) * pair.dx + Quad(pair.dy) * pair.dy);
    const Quad growth = 1 + Quad(g) * exact.delay;
    return 16 * u * (distance + pair.sigma * square_root(condition)) / square_root(a) *
           (growth * growth);
}

} // namespace

TEST_CASE("contacts of growing discs are as accurate as promised") {
    Approaches approaches(31);
    double worst = 0;
    int hits = 0, missed = 0, invented = 0, moving_apart = 0;
    for (int i = 0; i < 200000; ++i) {
        Approach c = approaches.any();
        if (i % 3 == 0) c.wx = -c.wx, c.wy = -c.wy;
        // Speeds above and below those at which discs meet, or separate.
        const double speed = std::hypot(c.wx, c.wy), distance = std::hypot(c.dx, c.dy);
        const double g = speed / distance * approaches.log_uniform(1e-6, 30);
        const GrowingContact exact(c, g);
        const double delay = delay_of(c, g);
        const Quad unclear = 64 * u * (exact.b * exact.b + absolute(exact.a) * absolute(exact.c));
        const bool is_near_graze = absolute(exact.discriminant) < unclear;
        const bool is_touching = absolute(exact.c) < 1e-12 * c.sigma * c.sigma;
        if (is_touching) {
            // They touch to within rounding, so the result depends on whether they approach. Grazes
            // are left out, because there the rounding of the gap decides.
            const double scale = c.sigma * (speed + c.sigma * g);
            if (exact.b < -1e-7 * scale) missed += delay < 0;
            if (exact.b > 1e-12 * scale && exact.a >= 0) invented += delay >= 0;
            continue;
        }
        if (is_near_graze) continue;
        missed += exact.delay >= 0 && delay < 0;
        invented += exact.delay < 0 && delay >= 0;
        if (delay < 0 || exact.delay < 0) continue;
        ++hits;
        moving_apart += c.dx * c.wx + c.dy * c.wy > 0;
        worst = std::max(worst, static_cast<double>(absolute(Quad(delay) - exact.delay) /
                                                    bound_of(c, g, exact)));
    }
    CAPTURE(worst, hits, moving_apart);
    CHECK(hits > 80000);
    CHECK(moving_apart > 1000);
    CHECK(missed == 0);
    CHECK(invented == 0);
    CHECK(worst <= 1);
}

TEST_CASE("growing pairs have the same bits exchanged, mirrored, transposed and without growth") {
    Approaches approaches(32);
    int differences = 0, hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const Approach c = approaches.any();
        const double g = approaches.log_uniform(1e-9, 10), delay = delay_of(c, g);
        hits += delay >= 0;
        differences += !same_bits(delay, delay_of({-c.dx, -c.dy, -c.wx, -c.wy, c.sigma}, g));
        differences += !same_bits(delay, delay_of({c.dy, c.dx, c.wy, c.wx, c.sigma}, g));
        differences += !same_bits(delay, delay_of({-c.dx, c.dy, -c.wx, c.wy, c.sigma}, g));
        differences += !same_bits(delay_of(c, 0),
                                  contact_delay(c.dx, c.dy, c.wx, c.wy, c.sigma, any_overlap));
    }
    CHECK(differences == 0);
    CHECK(hits > 50000);
}

TEST_CASE("discs at rest meet when they have grown") {
    CHECK(delay_of({4, 0, 0, 0, 2}, 0.125) == 8); // sigma is 2 (1 + t / 8)
    CHECK(delay_of({0, 3, 0, 0, 2}, 0.25) == Approx(2).epsilon(1e-15));
    CHECK(delay_of({4, 0, 0.25, 0, 2}, 0.125) < 0); // the discs separate as fast as they grow
    // they separate half as fast as they grow
    CHECK(delay_of({4, 0, 0.125, 0, 2}, 0.125) == Approx(16).epsilon(1e-15));
    // they touch, and grow faster than they separate
    CHECK(delay_of({2, 0, 0.125, 0, 2}, 0.125) == 0);
    CHECK(delay_of({2, 0, 0.5, 0, 2}, 0.125) < 0);
}

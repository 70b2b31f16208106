// SPDX-License-Identifier: BSD-3-Clause
// Discs that grow beside fixed bodies: contact times compared with a search by small steps, and
// reflections in the frame of the moving surface.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "catch.hpp"

#include "dynamics/fixed_bodies.hpp"
#include "flying_discs.hpp"

using namespace carrom;
using test::flying;
using test::uniform;

namespace {

/// A fixed disc, a segment and an arc, with the distance of a point from each.
struct Bodies {
    FixedDisc disc{30, 40, 5};
    Segment segment{60, 20, 80, 45};
    Arc arc{60, 70, 18, 20, 290};

    Effects effects() const {
        Effects all;
        all.fixed_bodies.discs = {disc};
        all.fixed_bodies.segments = {segment};
        all.fixed_bodies.arcs = {arc};
        return all;
    }
    double distance(double x, double y) const {
        return std::min(
            {std::hypot(x - disc.x, y - disc.y) - disc.radius, from_segment(x, y), from_arc(x, y)});
    }

private:
    double from_segment(double x, double y) const {
        const double ux = segment.x1 - segment.x0, uy = segment.y1 - segment.y0;
        const double along = ((x - segment.x0) * ux + (y - segment.y0) * uy) / (ux * ux + uy * uy);
        const double s = std::clamp(along, 0.0, 1.0);
        return std::hypot(x - segment.x0 - s * ux, y - segment.y0 - s * uy);
    }
    double from_arc(double x, double y) const {
        double angle = std::atan2(y - arc.y, x - arc.x) * 180 / std::numbers::pi;
        while (angle < arc.from) angle += 360;
        if (angle <= arc.to) return std::fabs(std::hypot(x - arc.x, y - arc.y) - arc.radius);
        const auto from_end = [&](double degrees) {
            const double a = degrees * std::numbers::pi / 180;
            return std::hypot(x - arc.x - arc.radius * std::cos(a),
                              y - arc.y - arc.radius * std::sin(a));
        };
        return std::min(from_end(arc.from), from_end(arc.to));
    }
};

/// The first time at which the distance is below the radius, found with small steps; `until` if
/// there is none before it.
double touch_by_steps(const Bodies& bodies, const DiscState& disc, const DiscSize& size,
                      double until) {
    const auto gap = [&](double t) {
        return bodies.distance(disc.x_at(t), disc.y_at(t)) - (size.radius + size.rate * t);
    };
    constexpr double step = 1e-3;
    for (double t = 0; t < until; t += step) {
        if (gap(t + step) > 0) continue;
        double low = t, high = t + step;
        for (int k = 0; k < 60; ++k) {
            const double middle = (low + high) / 2;
            (gap(middle) > 0 ? low : high) = middle;
        }
        return high;
    }
    return until;
}

} // namespace

TEST_CASE("growing discs meet fixed bodies when small steps of the distance say") {
    const Bodies bodies;
    const FixedBodies fixed(100, 0.5, bodies.effects());
    std::mt19937_64 random(5903);
    int n_found = 0, n_drawn = 0;
    constexpr double until = 30;
    while (n_drawn < 400) {
        const DiscSize size{uniform(random, 0.1, 0.5), uniform(random, 0.01, 0.5)};
        const DiscState disc = flying(uniform(random, 20, 85), uniform(random, 20, 90),
                                      uniform(random, -2, 2), uniform(random, -2, 2));
        if (bodies.distance(disc.x, disc.y) < size.radius + 1e-2) continue;
        n_drawn += 1;
        const double known = touch_by_steps(bodies, disc, size, until);
        const BodyContact found = fixed.first_contact(disc, size, {0, until});
        CAPTURE(disc.x, disc.y, disc.vx, disc.vy, size.radius, size.rate, known, found.time);
        REQUIRE(found.exists() == (known < until));
        if (found.exists()) CHECK(found.time == Approx(known).margin(1e-6));
        n_found += found.exists();
    }
    CHECK(n_found > 150);
}

TEST_CASE("growing discs leave a fixed body as the surface that meets it says") {
    Effects effects;
    effects.fixed_bodies.segments = {{0, 50, 100, 50}};
    for (const double restitution : {1.0, 0.5}) {
        effects.fixed_bodies.restitution = restitution;
        const FixedBodies line(100, 2, effects);
        // The surface approaches the line at 3 + 0.25; it leaves at this speed times `restitution`.
        DiscState disc = flying(20, 40, 1, 3);
        const DiscSize size{2, 0.25};
        const BodyContact contact = line.first_contact(disc, size, {0, 10});
        REQUIRE(contact.time == Approx(8 / 3.25).epsilon(1e-15));
        disc = {disc.x_at(contact.time), disc.y_at(contact.time), disc.vx, disc.vy, contact.time};
        line.rebound(disc, contact.body, contact.time, never, size.rate,
                     {nullptr, size.after(contact.time)});
        CHECK(disc.vx == 1);
        CHECK(disc.vy == Approx(-(0.25 + restitution * 3.25)).epsilon(1e-15));
        // The disc does not meet the line again, although rounding may have put it a bit too near.
        const DiscSize now{size.after(contact.time), size.rate};
        CHECK(!line.first_contact(disc, now, {contact.time, 100}).exists());
    }
    // A disc at rest in a closed circle touches it where the room ends.
    Effects round;
    round.fixed_bodies.arcs = {{50, 50, 10}};
    const FixedBodies circle(100, 1, round);
    const BodyContact contact = circle.first_contact(flying(53, 50, 0, 0), {1, 0.5}, {0, 100});
    CHECK(contact.time == Approx((10 - 3 - 1) / 0.5).epsilon(1e-14));
}

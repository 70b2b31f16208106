// SPDX-License-Identifier: BSD-3-Clause
// Contacts with arcs, and boxes made of arcs, compared with mirrors, polygons of many edges, and
// conserved quantities of round billiards.
#include <cmath>
#include <numbers>
#include <random>

#include "catch.hpp"

#include "dynamics/container.hpp"
#include "dynamics/fixed_bodies.hpp"
#include "flying_discs.hpp"

using namespace carrom;
using test::flying;
using test::uniform;

namespace {

Effects one_arc(const Arc& arc) {
    Effects effects;
    effects.fixed_bodies.arcs = {arc};
    return effects;
}

Effects shaped(BoxShape shape) {
    Effects effects;
    effects.fixed_bodies.shape = shape;
    return effects;
}

/// Reflects `disc` at the first obstacle it comes to, without the one that it has just left.
BodyContact reflect(const FixedBodies& obstacles, DiscState& disc, double radius,
                    std::uint32_t left = BodyContact::no_body) {
    const BodyContact contact = obstacles.first_contact(disc, {radius},
                                                        {disc.tau, 1e9, true, left});
    if (!contact.exists()) return contact;
    disc = {disc.x_at(contact.time), disc.y_at(contact.time), disc.vx, disc.vy, contact.time};
    obstacles.rebound(disc, contact.body, contact.time, never, 0, {nullptr, radius});
    return contact;
}

/// The first time at which a falling disc touches a point of the arc, found with small steps.
double touch_by_steps(const DiscState& disc, const Acceleration& g, double radius, const Arc& arc,
                      double until) {
    const auto gap = [&](double t) {
        const double x = disc.x + disc.vx * t + 0.5 * g.x * t * t - arc.x,
                     y = disc.y + disc.vy * t + 0.5 * g.y * t * t - arc.y;
        double angle = std::atan2(y, x) * 180 / std::numbers::pi;
        while (angle < arc.from) angle += 360;
        if (angle <= arc.to) return std::fabs(std::hypot(x, y) - arc.radius) - radius;
        double least = 1e9;
        for (const double end : {arc.from, arc.to}) {
            const double a = end * std::numbers::pi / 180;
            least = std::min(
                least,
                std::hypot(x - arc.radius * std::cos(a), y - arc.radius * std::sin(a)) - radius);
        }
        return least;
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
    return never;
}

} // namespace

TEST_CASE("arcs: faces are met a radius away from them, from outside and from inside") {
    const FixedBodies circle(100, 1, one_arc({50, 50, 10}));
    DiscState outside = flying(20, 50, 2, 0), inside = flying(50, 50, 0, 3);
    CHECK(reflect(circle, outside, 1).time == 9.5);
    CHECK(outside.vx == -2);
    CHECK(reflect(circle, inside, 1).time == 3);
    CHECK(inside.vy == -3);
    // A half circle that is open to the left: nothing stops a disc on the way in.
    const FixedBodies half(100, 1, one_arc({50, 50, 10, -90, 90}));
    DiscState guest = flying(20, 50, 2, 0);
    CHECK(reflect(half, guest, 1).time == 19.5);
    DiscState past = flying(20, 61.5, 2, 0);
    CHECK(!reflect(half, past, 1).exists());
    DiscState end = flying(20, 60, 2, 0); // head-on at the upper end
    CHECK(reflect(half, end, 1).time == 14.5);
    CHECK(end.vx == -2);
    // A disc that is larger than the arc only touches its ends.
    DiscState large = flying(20, 50, 2, 0);
    const FixedBodies small(100, 20, one_arc({50, 50, 10, -90, 90}));
    CHECK(reflect(small, large, 20).time == Approx((30 - std::sqrt(400.0 - 100)) / 2));
}

TEST_CASE("arcs: a disc alone in a round box keeps energy, angular momentum and chord") {
    std::mt19937_64 random(5901);
    const FixedBodies box(100, 2, shaped(BoxShape::round));
    for (int k = 0; k < 20; ++k) {
        DiscState disc = flying(uniform(random, 30, 70), uniform(random, 30, 70),
                                uniform(random, -1, 1), uniform(random, -1, 1));
        const double speed = std::hypot(disc.vx, disc.vy);
        const auto momentum = [&] { return (disc.x - 50) * disc.vy - (disc.y - 50) * disc.vx; };
        const double turns = momentum(), reach = 50 * (1 - 0x1p-30) - 2,
                     chord = 2 * std::sqrt(reach * reach - turns * turns / (speed * speed));
        std::uint32_t left = BodyContact::no_body;
        double last = 0;
        for (int n = 0; n < 1000; ++n) {
            // Times begin again, as at a sync.
            disc.tau = 0;
            const BodyContact contact = reflect(box, disc, 2, left);
            REQUIRE(contact.exists());
            if (n > 0) REQUIRE(contact.time * speed == Approx(chord).epsilon(1e-11));
            left = contact.body;
            last = contact.time;
        }
        CHECK(last > 0);
        CHECK(std::hypot(disc.vx, disc.vy) == Approx(speed).epsilon(1e-13));
        CHECK(momentum() == Approx(turns).margin(1e-11 * speed * 50));
    }
}

TEST_CASE("arcs: under gravity the first contact is that of small steps") {
    std::mt19937_64 random(5902);
    const Acceleration g{0.05, -0.2};
    int n_found = 0;
    for (int k = 0; k < 400; ++k) {
        const double from = uniform(random, -180, 180);
        const Arc arc{0, 0, uniform(random, 3, 8), from, from + uniform(random, 20, 340)};
        Effects effects;
        effects.gravity = g;
        effects.fixed_bodies.arcs = {{arc.x + 50, arc.y + 50, arc.radius, arc.from, arc.to}};
        const double radius = uniform(random, 0.2, 1);
        const FixedBodies obstacles(100, radius, effects);
        const double start = k % 2 == 0 ? 1.5 : 20;
        DiscState disc = flying(50 + uniform(random, -start, start),
                                50 + uniform(random, -start, start), uniform(random, -2, 2),
                                uniform(random, -2, 2));
        if (obstacles.deepest_overlap(disc.x, disc.y, radius, -1e-2).body != BodyContact::no_body)
            continue;
        DiscState from_centre = disc;
        from_centre.x -= 50;
        from_centre.y -= 50;
        const double known = touch_by_steps(from_centre, g, radius, arc, 30);
        const BodyContact found = obstacles.first_contact(disc, {radius}, {0, 30});
        CHECK(found.exists() == (known < never));
        if (found.exists()) CHECK(found.time == Approx(known).margin(1e-6));
        n_found += found.exists();
    }
    CHECK(n_found > 100);
}

TEST_CASE("arcs: in cells or one by one, the first contact is the same") {
    std::mt19937_64 random(5903);
    for (const double g : {0.0, -0.02}) {
        for (const bool is_periodic : {false, true}) {
            Effects effects;
            if (is_periodic)
                for (Boundary& side : effects.boundaries) side.kind = BoundaryKind::periodic;
            effects.gravity = {g / 3, g};
            std::vector<Effects> singles;
            for (int k = 0; k < 100; ++k) {
                Effects single = effects;
                single.fixed_bodies = {};
                const double from = uniform(random, -180, 180);
                single.fixed_bodies.arcs = {{uniform(random, 0, 100), uniform(random, 0, 100),
                                             uniform(random, 0.2, 6), from,
                                             from + uniform(random, 10, 360)}};
                effects.fixed_bodies.arcs.push_back(single.fixed_bodies.arcs[0]);
                singles.push_back(single);
            }
            const FixedBodies all(100, 0.5, effects);
            int n_found = 0;
            for (int k = 0; k < 200; ++k) {
                const DiscState disc = flying(uniform(random, 1, 99), uniform(random, 1, 99),
                                              uniform(random, -2, 2), uniform(random, -2, 2));
                double first = never;
                for (const Effects& single : singles)
                    first = std::min(
                        first,
                        FixedBodies(100, 0.5, single).first_contact(disc, {0.5}, {0, 20}).time);
                const BodyContact found = all.first_contact(disc, {0.5}, {0, 20});
                CHECK(found.time == first);
                n_found += found.exists();
            }
            CHECK(n_found > 100);
        }
    }
}

TEST_CASE("arcs: a drum that turns counterclockwise drags discs along on its inner face") {
    Effects effects = shaped(BoxShape::round);
    effects.fixed_bodies.surface = {0, std::numeric_limits<double>::infinity(), 0.3};
    const FixedBodies drum(100, 1, effects);
    DiscState disc = flying(50, 60, 0, -1); // to the lowest place, where the wall goes right
    reflect(drum, disc, 1);
    CHECK(disc.vx == Approx(0.3)); // the surface of the disc gets part of the wall's velocity
    CHECK(disc.vy == Approx(1));
    effects.fixed_bodies = {};
    effects.fixed_bodies.arcs = {{50, 50, 10}};
    effects.fixed_bodies.surface = {0, std::numeric_limits<double>::infinity(), 0.3};
    DiscState outside = flying(50, 20, 0, 1), inside = flying(50, 50, 0, -1);
    const FixedBodies ring(100, 1, effects);
    reflect(ring, outside, 1);
    reflect(ring, inside, 1);
    CHECK(outside.vx == Approx(0.3));
    CHECK(inside.vx == Approx(0.3));
    // A stadium turns as a belt does.
    effects.fixed_bodies.arcs.clear();
    effects.fixed_bodies.shape = BoxShape::stadium;
    const FixedBodies stadium({200, 100}, 1, effects);
    DiscState at_floor = flying(100, 50, 0, -1);
    reflect(stadium, at_floor, 1);
    CHECK(at_floor.vx == Approx(0.3));
}

TEST_CASE("arcs: boxes of other shapes know their area, and what is outside") {
    CHECK(Container(BoxShape::rectangle, {3, 4}).area() == 12);
    CHECK(Container(BoxShape::round, 10).area() == Approx(25 * std::numbers::pi).epsilon(1e-8));
    CHECK(Container(BoxShape::stadium, {20, 10}).area() ==
          Approx(100 + 25 * std::numbers::pi).epsilon(1e-8));
    CHECK(Container(BoxShape::stadium, {10, 20}).area() ==
          Approx(100 + 25 * std::numbers::pi).epsilon(1e-8));
    for (const Box box : {Box(20, 10), Box(10, 20)}) {
        const FixedBodies stadium(box, 1, shaped(BoxShape::stadium));
        CHECK(stadium.deepest_overlap(5, 5, 1, 0).body == BodyContact::no_body);
        const auto corner = stadium.deepest_overlap(0.1, 0.1, 1, 0);
        CHECK(stadium.name_of(corner.body) == "the stadium's wall");
        CHECK(corner.depth == Approx(std::hypot(4.9, 4.9) - 5 + 1));
    }
    Effects effects = one_arc({50, 50, 10, 0, 90});
    effects.fixed_bodies.polygons = {{10, 10, 20, 10, 15, 20}};
    const FixedBodies several(100, 1, effects);
    CHECK(several.name_of(several.deepest_overlap(50, 60.5, 1, 0).body) == "arc 1");
    CHECK(several.deepest_overlap(50, 40.5, 1, 0).body == BodyContact::no_body);
    CHECK(several.name_of(several.deepest_overlap(15, 9.5, 1, 0).body) == "polygon 1");
    CHECK(several.name_of(several.deepest_overlap(12, 14.5, 1, 0).body) == "polygon 1");
}

TEST_CASE("arcs: a stadium lets nothing out, whatever the radius") {
    std::mt19937_64 random(5904);
    for (const double radius : {2.0, 100 * 0x1p-30}) {
        const FixedBodies stadium({100, 50}, radius, shaped(BoxShape::stadium));
        for (int k = 0; k < 20; ++k) {
            DiscState disc = flying(uniform(random, 20, 80), uniform(random, 10, 40),
                                    uniform(random, -1, 1), uniform(random, -1, 1));
            std::uint32_t left = BodyContact::no_body;
            for (int n = 0; n < 2000; ++n) {
                disc.tau = 0;
                const BodyContact contact = reflect(stadium, disc, radius, left);
                REQUIRE(contact.exists());
                left = contact.body;
                REQUIRE(stadium.deepest_overlap(disc.x, disc.y, radius, 1e-12).body ==
                        BodyContact::no_body);
            }
        }
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Contacts with obstacles compared with mirrors; they must not depend on how a flight is divided
// into searches.
#include <cmath>
#include <random>

#include "catch.hpp"

#include "dynamics/fixed_bodies.hpp"
#include "flying_discs.hpp"

using namespace carrom;
using test::flying;
using test::uniform;

namespace {

Effects one_disc(double x, double y, double radius) {
    Effects effects;
    effects.fixed_bodies.discs = {{x, y, radius}};
    return effects;
}

/// Reflects `disc` at the first obstacle it comes to.
BodyContact reflect(const FixedBodies& obstacles, DiscState& disc, double radius = 1) {
    const BodyContact contact = obstacles.first_contact(disc, {radius}, {disc.tau, 1e6});
    disc = {disc.x_at(contact.time), disc.y_at(contact.time), disc.vx, disc.vy, contact.time};
    obstacles.rebound(disc, contact.body, contact.time, never, 0, {nullptr, radius});
    return contact;
}

} // namespace

TEST_CASE("obstacles: a disc is reflected as from a mirror") {
    SECTION("head on from a fixed disc") {
        DiscState disc = flying(10, 50, 2, 0);
        CHECK(reflect(FixedBodies(100, 1, one_disc(50, 50, 4)), disc).time == 17.5);
        CHECK(disc.vx == -2);
        CHECK(disc.vy == 0);
    }
    SECTION("off centre, by the angle that the impact parameter says") {
        DiscState disc = flying(10, 53, 2,
                                0); // 3 off, at a distance of 5: the normal is (-4, 3) / 5
        reflect(FixedBodies(100, 1, one_disc(50, 50, 4)), disc);
        CHECK(disc.x == Approx(46));
        CHECK(disc.vx == Approx(2 - 2 * 2 * 16.0 / 25));
        CHECK(disc.vy == Approx(2 * 2 * 12.0 / 25));
    }
    SECTION("a segment, from both sides") {
        Effects effects;
        effects.fixed_bodies.segments = {{40, 40, 60, 60}};
        const FixedBodies obstacles(100, 1, effects);
        DiscState left = flying(20, 50, 1, 0), right = flying(80, 50, -1, 0);
        CHECK(reflect(obstacles, left).time == Approx(30 - std::sqrt(2)));
        CHECK(reflect(obstacles, right).time == Approx(30 - std::sqrt(2)));
        CHECK(left.vx == Approx(0).margin(1e-15));
        CHECK(left.vy == Approx(1));
        CHECK(right.vx == Approx(0).margin(1e-15));
        CHECK(right.vy == Approx(-1));
    }
    SECTION("a segment's end is a point") {
        Effects effects;
        effects.fixed_bodies.segments = {{40, 50, 60, 50}};
        const FixedBodies obstacles(100, 1, effects);
        DiscState disc = flying(20, 50, 1, 0);
        CHECK(reflect(obstacles, disc).time == 19);
        CHECK(disc.vx == -1);
        CHECK(!obstacles.first_contact(flying(20, 51.5, 1, 0), {1}, {0, 1e6}).exists());
    }
}

TEST_CASE("obstacles: a ball bounces from a slope under gravity where Galileo says") {
    Effects effects;
    effects.gravity = {0, -0.5};
    effects.fixed_bodies.segments = {{10, 10, 90, 10}, {60, 60, 90, 90}};
    const FixedBodies obstacles(100, 1, effects);
    // States are stored in a frame that falls from time 0 on.
    DiscState level = flying(20, 36, 0.5, 0);
    CHECK(reflect(obstacles, level).time == Approx(10));
    CHECK(level.vy + effects.gravity.y * 10 == Approx(5)); // the velocity in the box
    CHECK(level.vx == 0.5);
    // It meets the slope with its centre at (75, 75 + sqrt(2)), 16 below its start.
    DiscState slope = flying(75, 75 + std::sqrt(2.0) + 16, 0, 0);
    CHECK(reflect(obstacles, slope).time == Approx(8));
    CHECK(slope.vx == Approx(-4));
    CHECK(slope.vy - 4 == Approx(0).margin(1e-12));
}

TEST_CASE("obstacles: looked for in cells or one by one, the first contact is the same") {
    std::mt19937_64 random(77);
    for (const double g : {0.0, -0.02}) {
        Effects effects;
        effects.gravity = {g / 3, g};
        std::vector<Effects> singles;
        for (int k = 0; k < 200; ++k) {
            Effects single;
            single.gravity = effects.gravity;
            if (k % 2 == 0) {
                single.fixed_bodies.discs = {
                    {uniform(random, 0, 100), uniform(random, 0, 100), k % 10 == 0 ? 5.0 : 0.3}};
                effects.fixed_bodies.discs.push_back(single.fixed_bodies.discs[0]);
            } else {
                const double x = uniform(random, 5, 95), y = uniform(random, 5, 95);
                single.fixed_bodies.segments = {
                    {x, y, x + uniform(random, -5, 5), y + uniform(random, -5, 5)}};
                effects.fixed_bodies.segments.push_back(single.fixed_bodies.segments[0]);
            }
            singles.push_back(single);
        }
        const FixedBodies all(100, 0.5, effects);
        int n_found = 0;
        for (int k = 0; k < 300; ++k) {
            const double tau = k % 3;
            const DiscState disc = flying(uniform(random, 1, 99), uniform(random, 1, 99),
                                          uniform(random, -2, 2), uniform(random, -2, 2), tau);
            const double to = k % 2 == 0 ? tau + 3 : tau + 30;
            BodyContact first;
            for (const Effects& single : singles) {
                const BodyContact contact =
                    FixedBodies(100, 0.5, single).first_contact(disc, {0.5}, {tau, to});
                if (contact.time < first.time) first = contact;
            }
            const BodyContact found = all.first_contact(disc, {0.5}, {tau, to});
            CHECK(found.time == first.time);
            n_found += found.exists();
            const double half = (tau + to) / 2; // two searches find the same
            const BodyContact early = all.first_contact(disc, {0.5}, {tau, half}),
                              late = all.first_contact(disc, {0.5}, {half, to, false});
            CHECK((early.exists() ? early.time : late.time) == found.time);
        }
        CHECK(n_found > 100);
    }
}

TEST_CASE("obstacles: what a disc overlaps is named") {
    Effects effects = one_disc(50, 50, 4);
    effects.fixed_bodies.segments = {{10, 10, 20, 10}, {70, 70, 90, 90}};
    const FixedBodies obstacles(100, 1, effects);
    CHECK(obstacles.deepest_overlap(50, 55.1, 1, 0).body == BodyContact::no_body);
    CHECK(obstacles.deepest_overlap(50, 54.5, 1, 0).depth == Approx(0.5));
    CHECK(obstacles.name_of(obstacles.deepest_overlap(50, 54.5, 1, 0).body) == "fixed disc 1");
    CHECK(obstacles.name_of(obstacles.deepest_overlap(80, 80.5, 1, 0).body) == "segment 2");
    CHECK(obstacles.name_of(obstacles.deepest_overlap(9.5, 10, 1, 0).body) == "segment 1");
    CHECK(FixedBodies(100, 1, Effects{}).deepest_overlap(50, 50, 1, 0).body ==
          BodyContact::no_body);
    for (const std::size_t side : {0u, 1u}) effects.boundaries[side].kind = BoundaryKind::periodic;
    effects.fixed_bodies.discs.push_back({99, 30, 3});
    CHECK(FixedBodies(100, 1, effects).deepest_overlap(2, 30, 1, 0).depth == Approx(1));
    CHECK(FixedBodies(100, 1, effects)
              .name_of(FixedBodies(100, 1, effects).deepest_overlap(2, 30, 1, 0).body) ==
          "fixed disc 2");
}

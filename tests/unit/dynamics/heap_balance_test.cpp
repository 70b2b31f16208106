// SPDX-License-Identifier: BSD-3-Clause
// Which discs hold each other, against statics: columns, corners, and three discs in a pile.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "dynamics/heap_balance.hpp"
#include "dynamics/resting.hpp"

using namespace carrom;

namespace {

constexpr double g = 0.01, r = 0.5;

Effects under_gravity(double gx, double gy) {
    Effects effects;
    effects.contact = {ContactKind::rough, 0.9, 0.001, 0, 0.5, 0.5};
    effects.gravity = {gx, gy};
    effects.rest = {0.01, 0.01 * r, 0.02};
    return effects;
}

HeapForces forces_on(const std::vector<HeapDisc>& discs, const Effects& effects) {
    HeapBalance balance(Box(100), effects);
    balance.set_discs(discs);
    return balance.find(std::vector<std::uint8_t>(discs.size(), 1));
}

std::size_t count_held(const HeapForces& forces) {
    return static_cast<std::size_t>(std::count_if(forces.left.begin(), forces.left.end(),
                                                  [](double left) { return left < 0.01; }));
}

/// Two discs that touch on the floor, and one on both.
HeapForces pile(double of_pairs, double of_floor) {
    Effects effects = under_gravity(0, -g);
    effects.contact.friction = of_pairs;
    effects.boundaries[2].surface = {0, of_floor, 0};
    const std::vector<HeapDisc> discs = {
        {0, 50, r, r, 1}, {1, 51, r, r, 1}, {2, 50.5, r + std::sqrt(3) * r, r, 1}};
    return forces_on(discs, effects);
}

} // namespace

TEST_CASE("heap balance: a column holds itself and presses the floor with its weight") {
    const Effects effects = under_gravity(0, -g);
    double weight = 0;
    std::vector<HeapDisc> discs;
    for (DiscId id = 0; id < 20; ++id) {
        const double mass = id % 3 == 0 ? 2 : 1;
        discs.push_back({id, 50, r + 2 * r * static_cast<double>(id), r, mass});
        weight += mass * g;
    }
    const HeapForces forces = forces_on(discs, effects);
    CHECK(count_held(forces) == 20);
    CHECK(forces.normal[2] == Approx(weight).epsilon(1e-3));
    CHECK(forces.normal[0] + forces.normal[1] + forces.normal[3] == 0);
    discs.erase(discs.begin() + 3); // what was above falls
    CHECK(count_held(forces_on(discs, effects)) == 3);
}

TEST_CASE("heap balance: a corner holds a disc with the components of its weight") {
    const HeapForces forces = forces_on({{7, r, r, r, 3}}, under_gravity(-0.3 * g, -g));
    CHECK(count_held(forces) == 1);
    CHECK(forces.normal[0] == Approx(0.9 * g).epsilon(1e-3));
    CHECK(forces.normal[2] == Approx(3 * g).epsilon(1e-3));
}

TEST_CASE("heap balance: a disc rolls down a slope, and lies between two") {
    Effects effects = under_gravity(0, -g);
    effects.obstacles.segments = {{40, 60, 50, 50}, {50, 50, 60, 60}};
    effects.obstacles.surface = {0, 0.9, 0};
    const double away = std::sqrt(0.5) * r;
    CHECK(count_held(forces_on({{0, 45 + away, 55 + away, r, 1}}, effects)) == 0);
    CHECK(count_held(forces_on({{0, 50, 50 + std::sqrt(2) * r, r, 1}}, effects)) ==
          1);
}

// The upper disc's forces go through the points where the lower ones touch the floor, so they are
// half of 30 degrees from the line of centres: pairs need tan(15 degrees), and the floor a third of
// that.
TEST_CASE("heap balance: three discs in a pile need the friction that statics says") {
    const double needed = 2 - std::sqrt(3);
    CHECK(count_held(pile(1.1 * needed, 1.1 * needed / 3)) == 3);
    CHECK(count_held(pile(0.9 * needed, 1)) < 3);
    CHECK(count_held(pile(1, 0.9 * needed / 3)) < 3);
    CHECK(count_held(pile(0, 0)) == 0);
    CHECK(pile(1.1 * needed, 1).normal[2] == Approx(3 * g).epsilon(1e-3));
}

TEST_CASE("heap balance: a floor that slides carries its disc away") {
    Effects effects = under_gravity(0, -g);
    effects.boundaries[2].surface = {0, 0.5, 0.1};
    CHECK(count_held(forces_on({{0, 50, r, r, 1}}, effects)) == 0);
}

TEST_CASE("resting places: the place in the box comes back from any time's state") {
    const RestingPlaces places(Box(60.7, 80), {0.003, -g});
    for (int k = 0; k < 1000; ++k) {
        Disc disc;
        disc.x = 60.7 * std::fmod(0.754877666 * k, 1);
        disc.y = 80 * std::fmod(0.569840291 * k, 1);
        disc.vx = 0.1;
        const double x = disc.x, y = disc.y;
        places.settle(disc);
        REQUIRE(std::fabs(disc.x - x) + std::fabs(disc.y - y) <= 8 * 0x1p-52 * 80);
        const Disc settled = disc;
        for (const double time : {0.37, 16.0, 3.1, 0.0}) {
            places.write_for(disc, time);
            REQUIRE(disc.tau == time);
            REQUIRE(places.x_of(disc) == settled.x);
            REQUIRE(places.y_of(disc) == settled.y);
        }
        REQUIRE(disc.x == settled.x);
        REQUIRE(disc.rests());
    }
}

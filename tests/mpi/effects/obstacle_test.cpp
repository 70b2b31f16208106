// SPDX-License-Identifier: BSD-3-Clause
// Known results for discs among obstacles.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "dynamics/fixed_bodies.hpp"
#include "effect_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Boundary periodic{BoundaryKind::periodic, 1, 0, 0};

/// Fixed discs of radius 2 on a shaken square grid in a box of side 10 n, and between them discs of
/// radius 0.25 that never collide with each other. With periodic sides the grid is shifted, so that
/// the sides cut fixed discs.
TestScene lorentz_gas(std::size_t n, std::size_t n_discs, bool is_periodic) {
    TestScene scene = empty_scene("Lorentz gas", 10 * static_cast<double>(n), 0.25, 1);
    Random random(701);
    FixedBodyList& list = scene.setting.effects.fixed_bodies;
    if (is_periodic) scene.setting.effects.boundaries.fill(periodic);
    const auto place = [&](std::size_t k) {
        return std::fmod(10 * static_cast<double>(k) + random.uniform(3.5, 6.5) +
                             (is_periodic ? 5 : 0),
                         scene.setting.box_size);
    };
    for (std::size_t k = 0; k < n * n; ++k) {
        const double x = place(k % n);
        list.discs.push_back({x, place(k / n), 2});
    }
    scene.setting.effects.contact.kind = ContactKind::none;
    const FixedBodies obstacles(scene.setting.box_size, scene.setting.radius,
                                scene.setting.effects);
    while (scene.discs.size() < n_discs) {
        const double x = random.uniform(0.25, scene.setting.box_size - 0.25),
                     y = random.uniform(0.25, scene.setting.box_size - 0.25);
        const auto [vx, vy] = random.direction();
        if (obstacles.deepest_overlap(x, y, scene.setting.radius, 0).body == BodyContact::no_body)
            add_disc(scene, x, y, 0.5 * vx, 0.5 * vy);
    }
    return scene;
}

/// An obstacle in the middle and a segment, both shifted along the diagonal if sides are periodic.
TestScene sinai_billiard(bool is_periodic, double moved) {
    TestScene scene = empty_scene("Sinai's billiard", 20, 0.5, is_periodic ? 96 : 64);
    if (is_periodic) scene.setting.effects.boundaries.fill(periodic);
    const auto at = [moved](double place) { return std::fmod(place + moved, 20); };
    scene.setting.effects.fixed_bodies.discs = {{at(10), at(10), 3}};
    scene.setting.effects.fixed_bodies.segments = {{at(2), at(12), at(5), at(17)}};
    add_disc(scene, at(3), at(4), 0.6, 0.35);
    add_disc(scene, at(16), at(5), -0.4, 0.3);
    return scene;
}

std::vector<DiscState> all_discs(const DiscSystem& system, const Communicator& world) {
    std::vector<DiscState> mine, all;
    for (const DiscState& disc : system.shown()) {
        mine.push_back(disc);
        mine.back().x = disc.x_at(system.clock());
        mine.back().y = disc.y_at(system.clock());
    }
    stream_to_root(
        world, std::span<const DiscState>(mine),
        [&](std::span<const DiscState> some) { all.insert(all.end(), some.begin(), some.end()); },
        1000);
    world.broadcast(all);
    std::sort(all.begin(), all.end(),
              [](const DiscState& a, const DiscState& b) { return a.id < b.id; });
    return all;
}

} // namespace

// The mean free path of a billiard is pi (free area) / (perimeter): N. Chernov, J. Stat. Phys. 88,
// 1 (1997). Here centres move, so obstacles are larger by a radius, and the box is smaller.
TEST_CASE(
    "effects: the mean free path in a Lorentz gas is what geometry says, under both methods") {
    const Communicator world = Communicator::world();
    for (const bool is_periodic : {false, true}) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            TestScene scene = lorentz_gas(8, 400, is_periodic);
            scene.steps = 512;
            const double side = is_periodic ? 80 : 80 - 0.5, reach = 2.25, n = 64;
            const double area = side * side - n * std::numbers::pi * reach * reach;
            const double perimeter = (is_periodic ? 0 : 4 * side) +
                                     n * 2 * std::numbers::pi * reach;
            const double known = std::numbers::pi * area / perimeter;
            const Totals end = run(scene, method, world);
            const double path = 400 * 0.5 * 512 / static_cast<double>(end.wall_collisions);
            CHECK(end.wall_collisions > 5000); // a relative error of 1.4 % at most
            // The time-stepped method loses hardly any collision, because a disc flies only a
            // twentieth of a mean free path in a step.
            CHECK(path == Approx(known).epsilon(method == Method::time_stepped ? 0.05 : 0.03));
            CHECK(end.kinetic_energy == Approx(400 * 0.125).epsilon(1e-12));
        }
    }
}

// Sinai's billiard multiplies an error of 1e-16 by some ten in each collision, so a dozen
// collisions can be reversed.
TEST_CASE("effects: Sinai's billiard runs back to where it began, between walls and periodic") {
    const Communicator world = Communicator::world();
    for (const bool is_periodic : {false, true}) {
        const TestScene scene = sinai_billiard(is_periodic, 0);
        DiscSystem there = system_of(scene, Method::event_driven, world);
        advance_to(there, scene.steps);
        CHECK(there.totals().wall_collisions >= 6);
        TestScene backwards = scene;
        for (const DiscState& disc : all_discs(there, world))
            backwards.discs[disc.id] = {disc.id, disc.x, disc.y, -disc.vx, -disc.vy};
        DiscSystem back = system_of(backwards, Method::event_driven, world);
        advance_to(back, scene.steps);
        for (const DiscState& disc : all_discs(back, world)) {
            CHECK(disc.x == Approx(scene.discs[disc.id].x).epsilon(1e-9));
            CHECK(disc.y == Approx(scene.discs[disc.id].y).epsilon(1e-9));
            CHECK(disc.vx == Approx(-scene.discs[disc.id].vx).epsilon(1e-9));
            CHECK(disc.vy == Approx(-scene.discs[disc.id].vy).epsilon(1e-9));
        }
    }
}

TEST_CASE("effects: where the seams are in a periodic box is of no account, under both methods") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        DiscSystem first = system_of(sinai_billiard(true, 0), method, world),
                   second = system_of(sinai_billiard(true, 10), method, world);
        advance_to(first, 96);
        advance_to(second, 96);
        CHECK(first.totals().wall_collisions >= 6);
        CHECK(first.totals().wall_collisions == second.totals().wall_collisions);
        const std::vector<DiscState> here = all_discs(first, world),
                                     there = all_discs(second, world);
        for (const DiscState& disc : here) {
            const auto apart = [](double a, double b) {
                return std::fabs(std::remainder(b - a - 10, 20));
            };
            CHECK(apart(disc.x, there[disc.id].x) < 1e-9);
            CHECK(apart(disc.y, there[disc.id].y) < 1e-9);
            CHECK(disc.vx == Approx(there[disc.id].vx).margin(1e-9));
            CHECK(disc.vy == Approx(there[disc.id].vy).margin(1e-9));
        }
    }
}

// Machta and Zwanzig, Phys. Rev. Lett. 50, 1959 (1983): fixed discs of radius R on a triangular
// lattice with gaps w trap points in cells of area A. Points go to a neighbouring cell at the
// distance l, through one of three gaps, after a mean time of pi A / (3 w v). So D = l^2 / 4
// divided by this time. It holds for narrow gaps (Klages and Dellago, J. Stat. Phys. 101, 145
// (2000)). 26 columns and 30 rows fit a square to 0.1 %.
TEST_CASE("effects: diffusion in a periodic Lorentz gas is that of hops from trap to trap") {
    const Communicator world = Communicator::world();
    constexpr double w = 0.1, spacing = 2 + w, size = 26 * spacing, point = 0.001;
    constexpr std::int64_t n_discs = 1000, lag = 100, first_lag = 20, n_lags = 8;
    TestScene scene = empty_scene("triangular Lorentz gas", size, point, n_lags * lag);
    scene.setting.effects.boundaries.fill(periodic);
    scene.setting.effects.contact.kind = ContactKind::none;
    for (int row = 0; row < 30; ++row)
        for (int k = 0; k < 26; ++k)
            scene.setting.effects.fixed_bodies.discs.push_back(
                {(k + 0.5 * (row % 2)) * spacing, row * size / 30, 1 - point});
    Random random(761);
    while (scene.discs.size() < n_discs) {
        for (int k = 0; k < n_discs; ++k) {
            const auto [vx, vy] = random.direction();
            const double x = random.uniform(0, size);
            add_disc(scene, x, random.uniform(0, size), vx, vy);
        }
        make_room_for_obstacles(scene);
    }
    DiscSystem system = system_of(scene, Method::event_driven, world);
    std::vector<DiscState> before = all_discs(system, world);
    // displacements since the lag began
    std::vector<double> x(before.size(), 0), y(before.size(), 0);
    double squares_at_first_lag = 0, squares_at_lag = 0;
    for (std::int64_t step = first_lag; step <= scene.steps; step += first_lag) {
        advance_to(system, step);
        const std::vector<DiscState> now = all_discs(system, world);
        double squares = 0;
        // in these few steps no disc flies through half the box
        for (std::size_t i = 0; i < now.size(); ++i) {
            x[i] += std::remainder(now[i].x - before[i].x, size);
            y[i] += std::remainder(now[i].y - before[i].y, size);
            squares += x[i] * x[i] + y[i] * y[i];
        }
        before = now;
        if (step % lag == first_lag) squares_at_first_lag += squares;
        if (step % lag != 0) continue;
        squares_at_lag += squares;
        std::fill(x.begin(), x.end(), 0);
        std::fill(y.begin(), y.end(), 0);
    }
    const auto n = static_cast<double>(before.size()) * n_lags;
    const double measured = (squares_at_lag - squares_at_first_lag) / n /
                            (4 * static_cast<double>(lag - first_lag));
    const double area = std::sqrt(3.0) / 4 * spacing * spacing - std::numbers::pi / 2;
    const double hop = spacing / std::sqrt(3.0), residence = std::numbers::pi * area / (3 * w);
    CHECK(measured ==
          Approx(hop * hop / (4 * residence))
              .epsilon(0.07)); // a standard error of 1.8 %, and corrections to the theory
}

TEST_CASE("effects: discs that fall through elastic pins keep their energy, and lossy ones come to "
          "rest on them") {
    const Communicator world = Communicator::world();
    TestScene scene = empty_scene("pins", 60, 0.5, 300);
    FixedBodyList& list = scene.setting.effects.fixed_bodies;
    for (int row = 0; row < 6; ++row)
        for (int k = 0; k < 9; ++k)
            list.discs.push_back({6.0 * k + (row % 2 == 0 ? 3 : 6), 10.0 + 6 * row, 0.5});
    list.segments = {{0, 8, 30, 3}, {60, 8, 30, 3}};
    for (int k = 0; k < 40; ++k) add_disc(scene, 2 + 1.4 * k, 52 + k % 3 * 2, 0.001 * k, 0);
    scene.setting.effects.gravity = {0, -0.01};
    DiscSystem system = system_of(scene, Method::event_driven, world);
    const Totals start = system.totals();
    advance_to(system, 203); // between two syncs
    const Totals end = system.totals();
    CHECK(end.wall_collisions > 200);
    CHECK(end.kinetic_energy + end.potential_energy ==
          Approx(start.kinetic_energy + start.potential_energy).epsilon(1e-12));

    list.restitution = 0.3;
    scene.setting.effects.contact.contact_time = 0.05;
    scene.setting.effects.contact.kind = ContactKind::restitution;
    scene.setting.effects.contact.restitution = 0.5;
    scene.steps = 600;
    const Totals rest = run(scene, Method::event_driven, world);
    CHECK(rest.kinetic_energy < 1e-3 * start.potential_energy);
    CHECK(rest.overlapping_pairs == 0);
}

TEST_CASE("effects: discs of several species meet obstacles where their own radii say, under both "
          "rules") {
    const Communicator world = Communicator::world();
    TestScene scene = empty_scene("two sizes", 100, 1, 20);
    scene.setting.effects.species = {{2, 1, 3}, {2, 0.3, 0.1}};
    scene.setting.effects.fixed_bodies = {
        {{50, 50, 4}}, {{50, 0, 50, 19.25}, {50, 20.75, 50, 45}}, 1};
    add_disc(scene, 10, 50, 2, 0);
    add_disc(scene, 20, 20, 2, 0); // a disc that flies to a slit of 1.5
    add_disc(scene, 90, 50, -2, 0);
    add_disc(scene, 40, 20.1, 2, 0);
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        DiscSystem system = system_of(scene, method, world);
        advance_to(system, 20);
        const std::vector<DiscState> end = all_discs(system, world);
        CHECK(end[0].x == Approx(45 - 2 * (20 - 17.5)).epsilon(1e-14));
        CHECK(end[1].x < 49);
        CHECK(end[2].x == Approx(54.3 + 2 * (20 - 17.85)).epsilon(1e-14));
        CHECK(end[3].x == Approx(80).epsilon(1e-14));
        CHECK(end[3].vx == 2);
    }
}

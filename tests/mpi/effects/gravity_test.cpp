// SPDX-License-Identifier: BSD-3-Clause
// Known results for discs that fall, and for discs under drag.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "dynamics/drag.hpp"
#include "effect_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double g = 0.01;

/// One disc of radius 1 that starts from rest at a height above the floor.
TestScene ball(double height, double restitution) {
    TestScene scene = empty_scene("ball", 128, 1, 1);
    add_disc(scene, 64, 1 + height, 0.0625, 0);
    scene.setting.effects.gravity = {0, -g};
    scene.setting.effects.boundaries[2].restitution = restitution;
    return scene;
}

/// Times of all collisions with walls, ascending. **Collective.**
std::vector<double> wall_times(TestScene scene, std::int64_t steps, const Communicator& world) {
    DiscSystem system = system_of(scene, Method::event_driven, world);
    std::vector<Collision> log, all;
    system.log_to(&log);
    advance_to(system, steps);
    stream_to_root(
        world, std::span<const Collision>(log),
        [&](std::span<const Collision> some) { all.insert(all.end(), some.begin(), some.end()); },
        1000);
    world.broadcast(all);
    std::vector<double> times;
    for (const Collision& c : all) times.push_back(static_cast<double>(c.micro_step) + c.time);
    std::sort(times.begin(), times.end());
    return times;
}

} // namespace

TEST_CASE("effects: a ball bounces when Galileo says") {
    const Communicator world = Communicator::world();
    for (const double restitution : {1.0, 0.8}) {
        TestScene scene = ball(50, restitution);
        scene.discs[0].vx = 0;
        const std::vector<double> times = wall_times(scene, 1000, world);
        const long double first = std::sqrt(100.0L / static_cast<long double>(g));
        long double expected = first, flight = 2 * first;
        double worst = 0;
        std::size_t n = 0;
        for (; n < times.size() && flight > 1; ++n) {
            worst = std::max(worst, static_cast<double>(std::fabs(times[n] - expected)));
            flight *= restitution;
            expected += flight;
        }
        CHECK(n >= (restitution == 1 ? 5u : 23u));
        CHECK(worst < 1e-9); // positions are rounded to 2^-46, and impact speeds are some 1: errors
                             // of a few 1e-14, which grow with each bounce
    }
}

TEST_CASE("effects: an elastic ball comes back to its height after ten thousand bounces; a lossy "
          "one comes to rest in bounded time") {
    const Communicator world = Communicator::world();
    const Totals start = run(ball(0.5, 1), Method::event_driven, world);
    TestScene scene = ball(0.5, 1);
    scene.steps = 200000;
    const Totals end = run(scene, Method::event_driven, world);
    CHECK(end.wall_collisions > 9000);
    CHECK(end.kinetic_energy + end.potential_energy ==
          Approx(start.kinetic_energy + start.potential_energy).epsilon(1e-10));

    scene = ball(5, 0.5);
    scene.steps = 400;
    scene.discs[0].vx = 0;
    scene.setting.effects.contact.contact_time = 0.01;
    const Totals rest = run(scene, Method::event_driven, world);
    CHECK(static_cast<double>(rest.wall_collisions) < 400 / 0.01);
    CHECK(rest.wall_collisions > 100);
    CHECK(rest.kinetic_energy + rest.potential_energy - g <
          0.05 * 0.02 * g); // the height that the contact time permits
}

TEST_CASE("effects: a gas that falls keeps its energy") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(400, 0.2, 0.5, 603);
    scene.setting.effects.gravity = {0.004, -0.01};
    DiscSystem system = system_of(scene, Method::event_driven, world);
    const Totals start = system.totals();
    for (const std::int64_t step : {37, 100, 203}) { // some of these steps are between syncs
        advance_to(system, step);
        const Totals now = system.totals();
        CHECK(now.kinetic_energy + now.potential_energy ==
              Approx(start.kinetic_energy + start.potential_energy).epsilon(1e-12));
        CHECK(now.overlapping_pairs == 0);
    }
    CHECK(system.totals().pair_collisions > 400);
}

// Above a floor of temperature T an ideal gas has the density exp(-g y / T), for discs of any size.
TEST_CASE("effects: the barometric formula over a thermal floor") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(2000, 0.02, 0.4, 604);
    const double temperature = 0.2;
    Effects& effects = scene.setting.effects;
    effects.contact.kind = ContactKind::none;
    effects.gravity = {0, -g};
    effects.boundaries[2] = {BoundaryKind::thermal, 1, temperature, 0};
    DiscSystem system = system_of(scene, Method::event_driven, world);
    advance_to(system, 3001); // twenty flights; the box is some 28 times T / g high
    std::vector<double> heights, all;
    for (const DiscState& disc : system.shown()) heights.push_back(disc.y - scene.setting.radius);
    stream_to_root(
        world, std::span<const double>(heights),
        [&](std::span<const double> some) { all.insert(all.end(), some.begin(), some.end()); },
        1000);
    world.broadcast(all);
    std::sort(all.begin(), all.end());
    const double n = static_cast<double>(all.size());
    double largest = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const double known = 1 - std::exp(-g * all[k] / temperature);
        largest = std::max(
            {largest, known - static_cast<double>(k) / n, static_cast<double>(k + 1) / n - known});
    }
    CHECK(all.size() == scene.discs.size());
    CHECK(largest * std::sqrt(n) < 1.95); // one sample in a thousand exceeds this (Kolmogorov)
}

TEST_CASE("effects: drag's clock is right to some ulp") {
    double worst = 0;
    for (const double rate : {1e-12, 1e-3, 0.02, 0.0625}) {
        for (int n = 1; n <= 64; ++n) {
            const long double z = static_cast<long double>(rate) * n;
            worst = std::max(
                {worst,
                 std::fabs(static_cast<double>(
                     drag_clock(rate, n) / (-std::expm1(-z) / static_cast<long double>(rate)) - 1)),
                 std::fabs(static_cast<double>(drag_slowing(rate, n) / std::exp(-z) - 1))});
            CHECK(time_of_drag_clock(rate, drag_clock(rate, n)) == Approx(n).epsilon(1e-13));
        }
    }
    CHECK(worst < 32 * 0x1p-53); // a rounding of the exponent, and some in each halving
}

TEST_CASE(
    "effects: drag leaves exp(-2 c t) of a gas's energy, and takes a disc where the formula says") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(300, 0.3, 0.5, 605);
    const double rate = 0.01;
    scene.setting.effects.drag = rate;
    DiscSystem system = system_of(scene, Method::event_driven, world);
    const double start = system.totals().kinetic_energy;
    for (const std::int64_t step : {37, 100, 203}) { // some of these steps are between syncs
        advance_to(system, step);
        const Totals now = system.totals();
        CHECK(now.kinetic_energy ==
              Approx(start * std::exp(-2 * rate * static_cast<double>(step))).epsilon(1e-12));
        CHECK(now.overlapping_pairs == 0);
    }
    CHECK(system.totals().pair_collisions > 100);

    TestScene alone = empty_scene("one disc", 100, 1, 300);
    add_disc(alone, 5, 50, 0.5, 0);
    alone.setting.effects.drag = rate;
    DiscSystem flight = system_of(alone, Method::event_driven, world);
    advance_to(flight, 300);
    for (const DiscState& disc : flight.shown())
        CHECK(disc.x == Approx(5 + 0.5 * -std::expm1(-3.0) / rate).epsilon(1e-13));
}

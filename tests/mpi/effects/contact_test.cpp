// SPDX-License-Identifier: BSD-3-Clause
// Known results for discs that lose energy in collisions, and for discs that never collide.
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"
#include "gathered.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// The position of a point between walls after the distance `way`, by unfolding its reflections,
/// and the sign of its velocity.
std::pair<long double, int> reflected(long double start, long double way, long double length) {
    const long double unfolded = start + way;
    const long double turns = std::floor(unfolded / length);
    const long double rest = unfolded - turns * length;
    const bool is_back = std::fmod(std::fabs(turns), 2.0L) == 1;
    return {is_back ? length - rest : rest, is_back ? -1 : 1};
}

} // namespace

// A collision dissipates (1 - e^2) of the normal part of a pair's energy in its rest frame. In a
// Maxwellian gas colliding pairs have <g_n^2> = 4 kT / m, so a collision takes (1 - e^2) kT on
// average. With E = N kT this gives ln(T / T0) = -(1 - e^2) pairs / N. The collision rate is
// proportional to sqrt(T), so 1 / sqrt(T) grows at a constant rate: Haff's law (J. Fluid Mech. 134,
// 401 (1983)).
TEST_CASE("effects: a thin gas cools by Haff's law") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(2500, 0.03, 0.1, 601);
    const double restitution = 0.95, loss = 1 - restitution * restitution;
    scene.setting.effects.contact = {ContactKind::restitution, restitution, 0.001};
    DiscSystem system = system_of(scene, Method::event_driven, world);
    // some three collisions a disc, because initial speeds are not Maxwell's
    advance_to(system, 300);
    const Totals start = system.totals();
    std::vector<double> slownesses;
    for (std::int64_t step = 300; step <= 2700; step += 800) {
        advance_to(system, step);
        slownesses.push_back(1 / std::sqrt(system.totals().kinetic_energy));
    }
    const Totals end = system.totals();
    const double n = static_cast<double>(scene.discs.size());
    const double pairs = static_cast<double>(end.pair_collisions - start.pair_collisions);
    const double cooling = std::log(start.kinetic_energy / end.kinetic_energy);
    CHECK(pairs > 4 * n);
    CHECK(cooling ==
          Approx(loss * pairs / n).epsilon(0.03)); // 4 standard errors of some 1e4 collisions
    const double first = slownesses[1] - slownesses[0], last = slownesses[3] - slownesses[2];
    CHECK(last == Approx(first).epsilon(0.08));
    CHECK(slownesses[3] > 1.25 * slownesses[0]);
    CHECK(end.overlapping_pairs == 0);
}

// With low restitution, three or more discs in a line come to rest relative to each other after
// infinitely many collisions (McNamara and Young, Phys. Fluids A 4, 496 (1992)). The contact time
// prevents that.
TEST_CASE("effects: inelastic collapse comes to an end, and energy only falls") {
    const Communicator world = Communicator::world();
    for (const std::size_t n : {3u, 30u}) {
        TestScene scene = cradle(n, 0.5, 0.25, 1);
        scene.setting.effects.contact = {ContactKind::restitution, 0.05, 0.001};
        DiscSystem system = system_of(scene, Method::event_driven, world);
        double before = system.totals().kinetic_energy;
        for (std::int64_t step = 10; step <= 100; step += 10) {
            advance_to(system, step);
            const double now = system.totals().kinetic_energy;
            CHECK(now <= before * (1 + 1e-12));
            before = now;
        }
        CHECK(system.totals().overlapping_pairs == 0);
    }
}

TEST_CASE("effects: discs that do not meet fly as if each were alone") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(400, 0.3, 2, 602);
    scene.steps = 100;
    scene.setting.effects.contact.kind = ContactKind::none;
    DiscSystem system = system_of(scene, Method::event_driven, world);
    advance_to(system, scene.steps);
    const double r = scene.setting.radius;
    const long double length = static_cast<long double>(scene.setting.box_size) - 2 * r;
    std::vector<InputDisc> start(scene.discs.size());
    for (const InputDisc& disc : scene.discs) start[disc.id] = disc;
    double farthest = 0;
    for (const DiscState& disc : gathered(system.discs(), world)) {
        const InputDisc& first = start[disc.id];
        const auto [x, x_sign] = reflected(first.x - r, 100.0L * first.vx, length);
        const auto [y, y_sign] = reflected(first.y - r, 100.0L * first.vy, length);
        farthest = std::max({farthest,
                             std::fabs(static_cast<double>(disc.x_at(system.clock()) - r - x)),
                             std::fabs(static_cast<double>(disc.y_at(system.clock()) - r - y))});
        CHECK(disc.vx == x_sign * first.vx);
        CHECK(disc.vy == y_sign * first.vy);
        CHECK(disc.pair_collisions == 0);
    }
    CHECK(farthest <
          100 * 4 * 0x1p-53 *
              scene.setting.box_size); // some ten bounces, each with a rounding of place and time
}

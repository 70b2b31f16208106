// SPDX-License-Identifier: BSD-3-Clause
// Known results for gases in boxes with periodic sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

TestScene periodic_gas(std::size_t n, double packing, double speed, std::uint64_t seed) {
    TestScene scene = gas(n, packing, speed, seed);
    for (Boundary& side : scene.setting.effects.boundaries) side.kind = BoundaryKind::periodic;
    return scene;
}

/// Z = P L^2 / (N kT) from the impulses of all collisions (the virial theorem). Momentum is
/// conserved, so two of the 2 N degrees of freedom are the common motion, and kT = (E - P^2 / 2N) /
/// (N - 1). With this kT, Z - 1 is 2 eta times the contact value of the pair correlation, for any
/// N. The run takes `n_collisions` to reach equilibrium and four times as many to measure.
/// **Collective.**
double compressibility(std::size_t n, double packing, double n_collisions,
                       const Communicator& world) {
    DiscSystem system = system_of(periodic_gas(n, packing, 0.5, 911), Method::event_driven, world);
    const auto run_until = [&](double wanted) {
        while (static_cast<double>(system.totals().pair_collisions) < wanted)
            advance_to(system, system.step() + 16);
    };
    run_until(n_collisions);
    std::vector<Collision> log;
    const std::int64_t begin = system.step();
    system.log_to(&log);
    run_until(5 * n_collisions);
    double impulse = 0;
    for (const Collision& collision : log) impulse += collision.impulse;
    double sum = 0;
    for (const double part : world.all_gather(impulse)) sum += part;
    const Totals totals = system.totals();
    const auto count = static_cast<double>(n), time = static_cast<double>(system.step() - begin);
    const double together = (totals.momentum_x * totals.momentum_x +
                             totals.momentum_y * totals.momentum_y) /
                            (2 * count);
    const double temperature = (totals.kinetic_energy - together) / (count - 1);
    return 1 + 2 * sum / (2 * time * count * temperature); // diameter 2
}

} // namespace

TEST_CASE("periodic: momentum and energy are conserved to rounding under both methods") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = periodic_gas(200, 0.4, 0.5, 901);
        for (InputDisc& disc : scene.discs) disc.vx += 0.25;
        scene.steps = 200;
        DiscSystem system = system_of(scene, method, world);
        const Totals start = system.totals();
        advance_to(system, scene.steps);
        const Totals end = system.totals();
        const auto n = static_cast<double>(end.pair_collisions);
        CHECK(n > 5000);
        CHECK(end.wall_collisions == 0);
        // Each collision rounds two velocities, of up to some 4, by half an ulp each.
        const double bound = n * 4 * 2 * 0x1p-53;
        CHECK(std::fabs(end.momentum_x - start.momentum_x) < bound);
        CHECK(std::fabs(end.momentum_y - start.momentum_y) < bound);
        CHECK(std::fabs(end.kinetic_energy / start.kinetic_energy - 1) < 1e-12);
        if (method == Method::event_driven) CHECK(end.overlapping_pairs == 0);
    }
}

// If the total momentum is 0, N discs have 3 N - 2 degrees of freedom, N of which are rotations. Of
// the others a species of N_k discs has 2 N_k (1 - m_k / M), where M is the total mass.
TEST_CASE("periodic: a mixture of perfectly rough discs keeps momentum and energy, and shares it "
          "among masses and spins") {
    const Communicator world = Communicator::world();
    TestScene scene = periodic_gas(180, 0.45, 0.5, 902);
    constexpr std::array<double, 2> counts{60, 120}, masses{5, 1};
    constexpr double n = 180, mass = 60 * 5 + 120;
    scene.setting.effects.species = {{60, 1, masses[0]}, {120, 0.7, masses[1]}};
    scene.setting.effects.contact = {
        ContactKind::rough, 1, 0.001, 1, std::numeric_limits<double>::infinity(), 0.5};
    double x = 0, y = 0;
    for (const InputDisc& disc : scene.discs)
        x += scene.setting.mass_of(disc.id) * disc.vx,
            y += scene.setting.mass_of(disc.id) * disc.vy;
    for (InputDisc& disc : scene.discs) disc.vx -= x / mass, disc.vy -= y / mass;
    DiscSystem system = system_of(scene, Method::event_driven, world);
    const Totals start = system.totals();
    advance_to(system, 120);
    constexpr int n_samples = 20;
    std::array<double, 3> energies{}; // energies of both species' translation, and of rotation
    for (int sample = 0; sample < n_samples; ++sample) {
        advance_to(system, system.step() + 20);
        for (const DiscState& disc : system.discs())
            energies[disc.id < 60 ? 0 : 1] += 0.5 * scene.setting.mass_of(disc.id) *
                                              (disc.vx * disc.vx + disc.vy * disc.vy) / n_samples;
        energies[2] += system.totals().rotational_energy / world.size() / n_samples;
    }
    std::array<double, 3> sums{};
    for (const auto& part : world.all_gather(energies))
        for (std::size_t k = 0; k < 3; ++k) sums[k] += part[k];
    const Totals end = system.totals();
    CHECK(end.pair_collisions > 4000);
    CHECK(end.kinetic_energy + end.rotational_energy ==
          Approx(start.kinetic_energy).epsilon(1e-12));
    const double bound = static_cast<double>(end.pair_collisions) * masses[0] * 4 * 2 * 0x1p-53;
    CHECK(std::fabs(end.momentum_x - start.momentum_x) < bound);
    CHECK(std::fabs(end.momentum_y - start.momentum_y) < bound);
    CHECK(end.overlapping_pairs == 0);
    const double half_temperature = start.kinetic_energy / (3 * n - 2);
    for (const std::size_t k : {0u, 1u}) {
        const double ways = 2 * counts[k] * (1 - masses[k] / mass);
        CHECK(sums[k] ==
              Approx(ways * half_temperature).epsilon(4 * std::sqrt(2 / (ways * n_samples))));
    }
    CHECK(sums[2] == Approx(n * half_temperature).epsilon(4 * std::sqrt(2 / (n * n_samples))));
}

TEST_CASE("periodic: a disc alone flies on, and comes in where it has left") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = empty_scene("one disc", 10, 1, 400);
        add_disc(scene, 9.5, 0.5, 1.75, -0.3);
        for (Boundary& side : scene.setting.effects.boundaries) side.kind = BoundaryKind::periodic;
        DiscSystem system = system_of(scene, method, world);
        for (const std::int64_t step : {3, 64, 200, 400}) {
            advance_to(system, step);
            const auto inside = [](long double place) {
                return static_cast<double>(place - 10 * std::floor(place / 10));
            };
            for (const DiscState& disc : system.shown()) {
                const auto t = static_cast<long double>(step);
                CHECK(disc.x == Approx(inside(9.5L + 1.75L * t)).margin(1e-12));
                CHECK(disc.y ==
                      Approx(inside(0.5L - static_cast<long double>(0.3) * t)).margin(1e-12));
            }
        }
        CHECK(system.totals().pair_collisions == 0);
    }
}

// The bulk pressure by the virial series to its tenth term (Clisby and McCoy 2006), at packings 0.1
// and 0.3. Without walls no extrapolation is needed.
TEST_CASE("periodic: the pressure of the bulk gas") {
    const Communicator world = Communicator::world();
    // N discs have a pressure that is lower by a share of about 1 / N, 0.1 % at packing 0.3. With
    // 60,000 collisions the error is 0.3 %.
    CHECK(compressibility(900, 0.1, 15000, world) == Approx(1.23614).epsilon(0.008));
    CHECK(compressibility(900, 0.3, 15000, world) == Approx(2.06316).epsilon(0.01));
}

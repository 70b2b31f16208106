// SPDX-License-Identifier: BSD-3-Clause
// Discs with a thermostat compared with kinetic theory.
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include <fmt/format.h>

#include "gas_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

TestScene periodic_gas(std::size_t n, double packing, std::uint64_t seed) {
    TestScene scene = crystal(n, packing, seed);
    for (Boundary& side : scene.setting.effects.boundaries) side.kind = BoundaryKind::periodic;
    scene.setting.sync_every = 1; // thermostats act in every step
    return scene;
}

/// Means over `n_samples` states, `apart` steps from each other: kT, and the cumulant <v^4> / (2
/// <v^2>^2) - 1, which is 0 for Maxwell's distribution.
struct Speeds {
    double temperature = 0, a2 = 0;
};
Speeds measured_speeds(DiscSystem& system, std::int64_t early, std::int64_t apart, int n_samples) {
    const auto to = [&](std::int64_t step) {
        while (system.step() < step) system.advance_towards(step);
    };
    to(early);
    double square = 0, fourth = 0, n = 0;
    for (int sample = 0; sample < n_samples; ++sample) {
        to(system.step() + apart);
        for (const DiscState& disc : system.discs()) {
            const double v2 = squared_speed_of(disc);
            square += v2;
            fourth += v2 * v2;
            n += 1;
        }
    }
    square /= n;
    fourth /= n;
    return {square / 2, fourth / (2 * square * square) - 1};
}

} // namespace

// In a Maxwellian gas a collision takes (1 - e^2) kT on average (m <g_n^2> / 4 with <g_n^2> = 4 kT
// / m). A disc has 2 sqrt(pi) n sigma g(sigma) sqrt(kT / m) collisions per time, and half of each
// loss. With kicks d(kT)/dt = m xi^2 - (1 - e^2) n sigma g sqrt(pi / m) (kT)^(3/2) (1 + 3 a2 / 16),
// which is 0 in the steady state. The fourth cumulant a2 is that of van Noije and Ernst, Granular
// Matter 1, 57 (1998), for d = 2. It follows from the balance of kicks and collisions in the fourth
// moment, to first order in a2.
void check_kicked_gas(std::initializer_list<double> restitutions) {
    const Communicator world = Communicator::world();
    const std::size_t n = 3000;
    // At a packing of 0.02 cumulants would be larger by 0.005
    const double packing = 0.0025, radius = 1;
    for (const double e : restitutions) {
        const double a2 = 16 * (1 - e) * (1 - 2 * e * e) / (185 - 153 * e + 30 * (1 - e) * e * e);
        const double g = (1 - 7 * packing / 16) / ((1 - packing) * (1 - packing));
        const double density = packing / (std::numbers::pi * radius * radius);
        const double kt = 4; // the temperature for which the strength is chosen
        const double loss = (1 - e * e) * density * 2 * radius * g * std::sqrt(std::numbers::pi);
        const double strength = loss * std::pow(kt, 1.5) * (1 + 3 * a2 / 16);
        TestScene scene = periodic_gas(n, packing, 31);
        scene.setting.effects.contact = {ContactKind::restitution, e, 1e-6};
        scene.setting.effects.thermostat = {ThermostatKind::kicks, strength, 0, 0, 17};
        scene.setting.sync_every = 8; // a disc collides once in 90 steps
        DiscSystem system = event_driven_system(scene, world);
        const Speeds speeds = measured_speeds(system, 1600, 240, 120);
        fmt::print("e = {}: kT {:.4f} of {}, a2 {:.4f}, theory {:.4f}\n", e, speeds.temperature, kt,
                   speeds.a2, a2);
        // Samples are taken just after a kick. The mean between two kicks is lower by half a kick.
        CHECK(speeds.temperature - 8 * strength / 2 == Approx(kt).epsilon(0.02));
        CHECK(std::fabs(speeds.a2 - a2) < 4 / 600.0); // four standard errors of 360,000 speeds
    }
}

TEST_CASE("physics: a gas that kicks heat has the temperature and the cumulant of kinetic theory") {
    check_kicked_gas({0.7});
}

TEST_CASE("physics: gases that kicks heat have the figures of kinetic theory, long", "[.long]") {
    check_kicked_gas({0.8, 0.9});
}

TEST_CASE("physics: Andersen and Langevin thermostats bring discs to Maxwell's distribution") {
    const Communicator world = Communicator::world();
    for (const ThermostatKind kind : {ThermostatKind::andersen, ThermostatKind::langevin}) {
        TestScene scene = periodic_gas(3000, 0.3, 32);
        scene.setting.effects.thermostat = {kind, 0, 0.2, 4, 18};
        DiscSystem system = event_driven_system(scene, world);
        const Speeds speeds = measured_speeds(system, 40, 10, 30);
        const Totals totals = system.totals();
        // Four standard errors of 90,000 speeds: both have the error 1 / sqrt(n).
        CHECK(speeds.temperature == Approx(4).epsilon(4 / 300.0));
        CHECK(std::fabs(speeds.a2) < 4 / 300.0);
        // Positions are distributed as without a thermostat. So the density at contact, on which
        // the collision rate depends, follows from the virial series at a packing fraction of 0.3,
        // Z = 2.0632 (Clisby and McCoy 2006). The first 40 of 340 steps start from a crystal, hence
        // 3 %.
        const double frequency = 4 / std::sqrt(std::numbers::pi) * (2.0632 - 1) / 2 *
                                 std::sqrt(speeds.temperature);
        CHECK(static_cast<double>(totals.pair_collisions) ==
              Approx(3000 * frequency * 340 / 2).epsilon(0.03));
    }
}

// Discs that never collide have D = kT / (m gamma), with a correction because the friction acts at
// syncs, a time t apart. Velocities keep the share c = exp(-gamma t) from flight to flight, so the
// mean square displacement grows by 4 D with D = kT t (1 + c) / (2 (1 - c)).
TEST_CASE("physics: Langevin discs that are alone diffuse by kT / gamma") {
    const Communicator world = Communicator::world();
    const std::size_t n = 10000;
    const double gamma = 0.2, kt = 0.01, time = 400;
    TestScene scene = periodic_gas(n, 0.01, 33);
    scene.setting.effects.contact.kind = ContactKind::none;
    scene.setting.effects.thermostat = {ThermostatKind::langevin, 0, gamma, kt, 19};
    DiscSystem system = event_driven_system(scene, world);
    while (system.step() < 50) system.advance_towards(50);
    std::vector<double> x(n), y(n);
    const double size = scene.setting.box_size;
    for (const DiscState& disc : system.shown()) {
        x[disc.id] = disc.x_at(system.clock());
        y[disc.id] = disc.y_at(system.clock());
    }
    const std::int64_t last = 50 + static_cast<std::int64_t>(time);
    while (system.step() < last) system.advance_towards(last);
    double square = 0;
    for (const DiscState& disc : system.shown()) {
        // They move by some 30 at most, in a box of 1772.
        const double dx = std::remainder(disc.x_at(system.clock()) - x[disc.id], size),
                     dy = std::remainder(disc.y_at(system.clock()) - y[disc.id], size);
        square += dx * dx + dy * dy;
    }
    const double c = std::exp(-gamma), d = kt * (1 + c) / (2 * (1 - c));
    const double correction = 1 - (1 - std::exp(-gamma * time)) / (gamma * time);
    CHECK(square / static_cast<double>(n) ==
          Approx(4 * d * time * correction).epsilon(4 / std::sqrt(static_cast<double>(n))));
    CHECK(d == Approx(kt / gamma).epsilon(0.01));
}

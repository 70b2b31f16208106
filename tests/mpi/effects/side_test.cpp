// SPDX-License-Identifier: BSD-3-Clause
// Known results for walls that take energy, give energy, or move.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Kinetic energy per disc, averaged over `n_samples` states, `apart` steps from each other.
double mean_energy(DiscSystem& system, int n_samples, std::int64_t apart) {
    double sum = 0;
    for (int k = 0; k < n_samples; ++k) {
        advance_to(system, system.step() + apart);
        const Totals totals = system.totals();
        sum += totals.kinetic_energy / static_cast<double>(totals.n_discs);
    }
    return sum / n_samples;
}

} // namespace

TEST_CASE("effects: walls of one temperature give it to a gas, under both methods") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = gas(400, 0.1, 0.2, 605);
        scene.steps = 1000000;
        for (Boundary& side : scene.setting.effects.boundaries)
            side = {BoundaryKind::thermal, 1, 0.5, 0};
        DiscSystem system = system_of(scene, method, world);
        advance_to(system, 1500);
        // E / N has the mean T and the variance T^2 / N. 30 nearly independent samples have an
        // error of some 1 %.
        CHECK(mean_energy(system, 30, 150) == Approx(0.5).epsilon(0.04));
    }
}

// Without collisions, discs from a wall of temperature T_k fill the box with a density proportional
// to 1 / sqrt(T_k), so <v^2> / 2 = sqrt(T_1 T_2) (Knudsen's gas between two plates).
TEST_CASE("effects: an ideal gas between walls of two temperatures has their geometric mean") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(1000, 0.02, 0.5, 606);
    Effects& effects = scene.setting.effects;
    effects.contact.kind = ContactKind::none;
    effects.boundaries[0] = {BoundaryKind::thermal, 1, 1, 0};
    effects.boundaries[1] = {BoundaryKind::thermal, 1, 9, 0};
    DiscSystem system = system_of(scene, Method::event_driven, world);
    advance_to(system, 4000);
    // Slow discs take long to cross the box, so samples are correlated. The energies of single
    // discs have a standard deviation of about twice their mean, 3.
    CHECK(mean_energy(system, 20, 400) == Approx(3).epsilon(0.06));
}

TEST_CASE("effects: walls take what their restitution says") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = empty_scene("one disc", 16, 1, 14 * 4);
        add_disc(scene, 8, 8, 1, 0);
        scene.setting.effects.boundaries[0].restitution = 0.5;
        scene.setting.effects.boundaries[1].restitution = 0.25;
        scene.steps = 40; // reaches the right side at 7, then flies 14 / 0.25 = 56 steps back
        CHECK(run(scene, method, world).kinetic_energy == 0.5 * 0.0625);
        scene.steps = 70;
        CHECK(run(scene, method, world).kinetic_energy == 0.5 * 0.0625 * 0.25);
    }
}

TEST_CASE("effects: a disc before a piston is where arithmetic says") {
    const Communicator world = Communicator::world();
    TestScene scene = empty_scene("piston", 102, 1, 300);
    add_disc(scene, 40, 50, 0.7, 0);
    const double u = 0.2;
    scene.setting.effects.boundaries[1] = {BoundaryKind::moving, 1, 0, -u};
    DiscSystem system = system_of(scene, Method::event_driven, world);
    advance_to(system, scene.steps);
    long double x = 40, v = 0.7, t = 0;
    int n = 0;
    for (;; ++n) { // flies between the wall at 1 and the piston at 101 - u t
        const long double speed = -static_cast<long double>(u);
        const long double to_piston = (101 + speed * t - x) / (v - speed),
                          to_wall = v < 0 ? (1 - x) / v : 1e9L;
        const long double delay = v < 0 ? to_wall : to_piston;
        if (t + delay > 300) break;
        t += delay;
        x += v * delay;
        v = v < 0 ? -v : 2 * speed - v;
    }
    x += v * (300 - t);
    CHECK(n >= 4);
    for (const DiscState& disc : system.discs()) {
        CHECK(disc.x_at(system.clock()) == Approx(static_cast<double>(x)).epsilon(1e-13));
        CHECK(disc.vx == Approx(static_cast<double>(v)).epsilon(1e-13));
    }
}

// A wall hits a disc that gravity pulls away from it, at the first root of x = d + (v - u) t + g
// t^2 / 2 = 0. At the end the disc is far from all positions of the wall.
TEST_CASE("effects: a wall hits a disc that falls away from it afterwards") {
    const Communicator world = Communicator::world();
    for (const std::size_t side : {0u, 1u, 2u, 3u}) {
        INFO("side " << side);
        TestScene scene = empty_scene("wall behind a falling disc", 102, 1, 32);
        const double d = 0.01, u = 0.04, v = 0.03, g = 0.002, sign = side % 2 == 0 ? 1 : -1;
        const double place = side % 2 == 0 ? 1 + d : 101 - d;
        if (side < 2)
            add_disc(scene, place, 50, sign * v, 0);
        else
            add_disc(scene, 50, place, 0, sign * v);
        scene.setting.effects.boundaries[side] = {BoundaryKind::moving, 1, 0, sign * u};
        (side < 2 ? scene.setting.effects.gravity.x : scene.setting.effects.gravity.y) = sign * g;
        DiscSystem system = system_of(scene, Method::event_driven, world);
        advance_to(system, scene.steps);
        const long double hit = ((static_cast<long double>(u) - v) -
                                 std::sqrt((u - static_cast<long double>(v)) *
                                               (u - static_cast<long double>(v)) -
                                           2.0L * g * d)) /
                                g;
        const long double after = 2.0L * u - (v + g * hit), rest = 32 - hit;
        const long double x = u * hit + after * rest +
                              0.5L * g * rest *
                                  rest; // position of the disc's edge relative to the wall's start
        CHECK(system.totals().wall_collisions == 1);
        for (const DiscState& disc : system.shown()) {
            const double at = side < 2 ? disc.x : disc.y,
                         from_wall = side % 2 == 0 ? at - 1 : 101 - at;
            CHECK(from_wall == Approx(static_cast<double>(x)).epsilon(1e-12));
        }
    }
}

// All four walls move in. Each component of a velocity times its length is an adiabatic invariant,
// so E L^2 is constant (p V^2 with V = L^2). An impulse J of a wall with the speed u does the work
// J u.
TEST_CASE("effects: an ideal gas is compressed adiabatically, and its energy is the work done") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(1500, 0.01, 1, 607);
    const double u = 0.004;
    Effects& effects = scene.setting.effects;
    effects.contact.kind = ContactKind::none;
    for (std::size_t k = 0; k < 4; ++k)
        effects.boundaries[k] = {BoundaryKind::moving, 1, 0, k % 2 == 0 ? u : -u};
    DiscSystem system = system_of(scene, Method::event_driven, world);
    std::vector<Collision> log;
    system.log_to(&log);
    const double length = scene.setting.box_size - 2 * scene.setting.radius;
    const double start = system.totals().kinetic_energy;
    const auto steps = static_cast<std::int64_t>(length / (8 * u)); // L decreases by a quarter
    advance_to(system, steps);
    const double end = system.totals().kinetic_energy,
                 now = length - 2 * u * static_cast<double>(steps);
    double impulse = 0;
    for (const Collision& collision : log) impulse += collision.impulse;
    std::vector<double> impulses = world.all_gather(impulse);
    double work = 0;
    for (const double part : impulses) work += part * u;
    CHECK(end - start == Approx(work).epsilon(1e-11));
    CHECK(end * now * now == Approx(start * length * length).epsilon(0.01));
    CHECK(end > 1.7 * start);
}

// Discs that never collide leave at the time and place that follow from their flights, unfolded at
// the closed walls. Afterwards they stay at the place where they left.
TEST_CASE("effects: discs leave through open sides when their flights say, and are counted") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = gas(300, 0.05, 0.8, 608);
        Effects& effects = scene.setting.effects;
        effects.contact.kind = ContactKind::none;
        effects.boundaries[1] = effects.boundaries[2] = {BoundaryKind::open, 1, 0, 0};
        scene.steps = 60;
        const long double r = scene.setting.radius, size = scene.setting.box_size;
        std::array<std::uint64_t, 4> known{};
        for (const InputDisc& disc : scene.discs) {
            const long double way_x = disc.vx > 0 ? size + r - disc.x
                                                  : (disc.x - r) + (size + r - r);
            const long double way_y = disc.vy < 0 ? disc.y + r
                                                  : (size - r - disc.y) + (size - r + r);
            const long double tx = disc.vx == 0
                                       ? 1e9L
                                       : way_x / std::fabs(static_cast<long double>(disc.vx));
            const long double ty = disc.vy == 0
                                       ? 1e9L
                                       : way_y / std::fabs(static_cast<long double>(disc.vy));
            if (std::min(tx, ty) <= 60) known[tx < ty ? 1 : 2] += 1;
        }
        DiscSystem system = system_of(scene, method, world);
        advance_to(system, 60);
        const Totals totals = system.totals();
        INFO((method == Method::time_stepped ? "time-stepped" : "event-driven"));
        CHECK(totals.departed == known);
        CHECK(known[1] > 20);
        CHECK(known[2] > 20);
        CHECK(totals.n_discs == 300);
        for (const DiscState& disc : system.shown()) {
            if (!disc.has_departed()) continue;
            CHECK((disc.x == scene.setting.box_size + scene.setting.radius ||
                   disc.y == -scene.setting.radius));
            CHECK((disc.vx == 0 && disc.vy == 0));
        }
    }
}

TEST_CASE("effects: a box without sides empties, and time goes on") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = gas(100, 0.3, 0.5, 609);
        for (Boundary& side : scene.setting.effects.boundaries)
            side = {BoundaryKind::open, 1, 0, 0};
        scene.steps = 3000;
        const Totals end = run(scene, method, world);
        CHECK(end.departed[0] + end.departed[1] + end.departed[2] + end.departed[3] == 100);
        CHECK(end.kinetic_energy == 0);
        CHECK(end.overlapping_pairs == 0);
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Discs of several radii and masses: the references' bits, the plain dynamics' bits if all discs
// are equal, and known results for mixtures.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.hpp"

#include "parallel/exchange.hpp"
#include "reference_bits.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Discs of these species at random without overlaps, the largest species first; speeds in largest
/// diameters per step.
TestScene mixture(const std::vector<Species>& species, double box_size, double speed,
                  std::uint64_t seed) {
    double largest = 0;
    for (const Species& one : species) largest = std::max(largest, one.radius);
    TestScene scene = empty_scene("mixture", box_size, largest, 14);
    scene.setting.effects.species = species;
    scene.setting.sync_every = 5;
    scene.setting.micro_steps = 2;
    Random random(seed);
    add_species(scene, false, false, random);
    set_speeds(scene, 2 * largest * speed, random);
    return scene;
}

/// Mixtures of three sizes, with masses that are not a function of the sizes.
std::vector<TestScene> mixtures() {
    const std::vector<Species> three{{12, 2.5, 3}, {60, 1, 1.3}, {150, 0.3, 0.07}};
    std::vector<Species> many; // more species than are searched one by one
    for (int k = 0; k < 40; ++k)
        many.push_back({1 + static_cast<std::uint64_t>(k % 3), 2 - 0.04 * k, 1 + 0.5 * (k % 4)});
    return {mixture(three, 40, 0.6, 701), mixture(three, 31, 0.2, 702),
            mixture(many, 30, 0.4, 703)};
}

/// Points and segments between discs, `n` of each.
void put_bodies_between(TestScene& scene, std::size_t n, std::uint64_t seed) {
    Random random(seed);
    const double size = scene.setting.box_size;
    FixedBodyList& list = scene.setting.effects.fixed_bodies;
    const auto is_clear = [&scene](double x, double y, double ux, double uy, double length) {
        return std::all_of(scene.discs.begin(), scene.discs.end(), [&](const InputDisc& disc) {
            const double along = std::clamp(ux * (disc.x - x) + uy * (disc.y - y), 0.0, length);
            return std::hypot(disc.x - x - along * ux, disc.y - y - along * uy) >
                   1.001 * scene.setting.radius_of(disc.id);
        });
    };
    while (list.discs.size() < n || list.segments.size() < n) {
        const double x = random.uniform(0.1, 0.9) * size, y = random.uniform(0.1, 0.9) * size,
                     length = random.uniform(0.01, 0.1) * size;
        const auto [ux, uy] = random.direction();
        if (is_clear(x, y, 0, 0, 0) && list.discs.size() < n)
            list.discs.push_back({x, y, 0});
        else if (is_clear(x, y, ux, uy, length) && list.segments.size() < n)
            list.segments.push_back({x, y, x + length * ux, y + length * uy});
    }
}

double mass_of(const TestScene& scene, DiscId id) { return scene.setting.mass_of(id); }

} // namespace

TEST_CASE("effects: mixtures have the references' bits, alone and with other effects") {
    for (TestScene scene : mixtures()) {
        Effects& effects = scene.setting.effects;
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
        effects.contact = {ContactKind::restitution, 0.8, 0.002};
        effects.boundaries[3].restitution = 0.7;
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
        effects.gravity = {0.01, -0.03};
        effects.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.03};
        effects.boundaries[2] = {BoundaryKind::thermal, 1, 0.3, 0};
        set_thermal_seed(scene.setting, 77);
        check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("effects: mixtures among obstacles have the references' bits") {
    for (TestScene scene : mixtures()) {
        put_bodies_between(scene, 5, 711);
        scene.setting.effects.fixed_bodies.restitution = 0.9;
        for (InputDisc& disc : scene.discs)
            // so that many discs have a second collision in the same micro-step
            disc.vx *= 2, disc.vy *= 2;
        for (const Method method : {Method::time_stepped, Method::event_driven})
            check_bits(scene, method);
    }
}

TEST_CASE("effects: mixtures leave through open sides, each disc a radius of its own beyond them, "
          "with the references' bits") {
    const Communicator world = Communicator::world();
    for (TestScene scene : mixtures()) {
        const double size = scene.setting.box_size;
        scene.setting.effects.boundaries[0] = scene.setting.effects.boundaries[3] = {
            BoundaryKind::open, 1, 0, 0};
        for (const ContactEffect& contact :
             {ContactEffect{}, ContactEffect{ContactKind::rough, 0.9, 0.002, 0.4, 0.3, 0.5}}) {
            scene.setting.effects.contact = contact;
            for (const Method method : {Method::time_stepped, Method::event_driven}) {
                check_bits(scene, method);
                DiscSystem system = system_of(scene, method, world);
                advance_to(system, scene.steps);
                const Totals totals = system.totals();
                CHECK((totals.departed[0] > 2 && totals.departed[3] > 2));
                const std::span<const DiscState> discs = system.discs();
                const std::span<const double> spins = system.spins();
                for (std::size_t i = 0; i < discs.size(); ++i) {
                    if (!discs[i].has_departed()) continue;
                    const double radius = scene.setting.radius_of(discs[i].id);
                    CHECK((discs[i].x == -radius || discs[i].y == size + radius));
                    CHECK(
                        (discs[i].vx == 0 && discs[i].vy == 0 && (spins.empty() || spins[i] == 0)));
                }
            }
        }
    }
}

TEST_CASE("effects: species of one radius and one mass are the plain dynamics to the bit") {
    const Communicator world = Communicator::world();
    for (TestScene scene : base_scenes()) {
        for (const Method method : {Method::time_stepped, Method::event_driven}) {
            INFO(scene.name);
            scene.setting.effects = {};
            const Totals plain = run(scene, method, world);
            const double r = scene.setting.radius;
            for (const double mass : {1.0, 0.3}) {
                scene.setting.effects.species = {{5, r, mass}, {scene.discs.size() - 5, r, mass}};
                const Totals mixed = run(scene, method, world);
                CHECK(to_string(mixed.hash) == to_string(plain.hash));
                CHECK(mixed.overlapping_pairs == plain.overlapping_pairs);
                CHECK(mixed.kinetic_energy == Approx(mass * plain.kinetic_energy).epsilon(1e-14));
            }
        }
    }
}

// An elastic head-on collision, by the conservation of momentum and energy.
TEST_CASE("effects: unequal discs exchange momentum as mechanics says, touching at the sum of "
          "their radii") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = empty_scene("two discs", 64, 4, 12);
        scene.setting.effects.species = {{1, 4, 5}, {1, 1, 0.5}};
        add_disc(scene, 20, 32, 1, 0);
        add_disc(scene, 35, 32, 0, 0);
        DiscSystem system = system_of(scene, method, world);
        std::vector<Collision> log;
        system.log_to(&log);
        advance_to(system, scene.steps);
        for (const DiscState& disc : system.discs()) {
            const double expected = disc.id == 0 ? (5 - 0.5) / 5.5 : 2 * 5 / 5.5;
            CHECK(disc.vx == Approx(expected).epsilon(1e-14));
            CHECK(disc.x_at(system.clock()) ==
                  Approx(disc.id == 0 ? 30 + 2 * expected : 35 + 2 * expected).epsilon(1e-14));
            CHECK(disc.pair_collisions == 1);
        }
        for (const Collision& collision : log)
            CHECK(collision.impulse == Approx(0.5 * 2 * 5 / 5.5).epsilon(1e-14));
        const Totals totals = system.totals();
        CHECK(totals.kinetic_energy == Approx(2.5).epsilon(1e-14));
        CHECK(totals.momentum_x == Approx(5).epsilon(1e-14));
    }
}

// Each species has kT = <m v^2> / 2 per disc. Samples are several collisions apart. In one sample
// the energy of N discs has a relative error of 1 / sqrt(N).
TEST_CASE("effects: a mixture that starts with equal speeds comes to equal energies") {
    const Communicator world = Communicator::world();
    TestScene scene = mixture({{100, 1.5, 8}, {200, 1, 2}, {300, 0.5, 0.5}}, 80, 0.2, 704);
    scene.setting.micro_steps = 1;
    scene.setting.sync_every = 64;
    DiscSystem system = system_of(scene, Method::event_driven, world);
    const Totals start = system.totals();
    advance_to(system, 1000);
    std::vector<double> sums(3, 0);
    constexpr int n_samples = 40;
    for (int sample = 0; sample < n_samples; ++sample) {
        advance_to(system, system.step() + 50);
        std::vector<double> energies(3, 0);
        for (const DiscState& disc : system.discs())
            energies[disc.id < 100   ? 0
                     : disc.id < 300 ? 1
                                     : 2] += 0.5 * mass_of(scene, disc.id) *
                                             (disc.vx * disc.vx + disc.vy * disc.vy);
        for (const auto& part : world.all_gather(std::array{energies[0], energies[1], energies[2]}))
            for (std::size_t k = 0; k < 3; ++k) sums[k] += part[k] / n_samples;
    }
    const Totals end = system.totals();
    const double mean = end.kinetic_energy / 600;
    CHECK(sums[0] / 100 == Approx(mean).epsilon(4 / std::sqrt(100.0 * n_samples)));
    CHECK(sums[1] / 200 == Approx(mean).epsilon(4 / std::sqrt(200.0 * n_samples)));
    CHECK(sums[2] / 300 == Approx(mean).epsilon(4 / std::sqrt(300.0 * n_samples)));
    CHECK(end.kinetic_energy == Approx(start.kinetic_energy).epsilon(1e-12));
    CHECK(end.overlapping_pairs == 0);
    CHECK(end.pair_collisions > 600 * 20);
}

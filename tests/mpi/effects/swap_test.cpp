// SPDX-License-Identifier: BSD-3-Clause
// Swap moves in runs: the same bits on every machine shape, no overlaps, and the same energy.
#include <algorithm>
#include <span>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

TestScene swapping(std::uint64_t seed) {
    TestScene scene = gas(240, 0.4, 0.1, seed);
    scene.setting.sync_every = 6;
    scene.setting.micro_steps = 2;
    scene.steps = 40;
    Effects& effects = scene.setting.effects;
    effects.boundaries.fill({BoundaryKind::periodic, 1, 0, 0});
    for (int k = 0; k < 24; ++k) effects.species.push_back({10, 0.4 + 0.025 * k, 1.0 + k % 3});
    effects.swap = {4, 0, seed};
    return scene;
}

} // namespace

TEST_CASE("effects: swaps give the same bits on every machine shape, and are checked") {
    const Communicator world = Communicator::world();
    for (const std::uint64_t seed : {690u, 691u}) {
        TestScene scene = swapping(seed);
        check_shared_run(scene, Method::event_driven, world);
        scene.setting.effects.thermostat = {ThermostatKind::langevin, 0, 0.1, 0.02, 7};
        check_shared_run(scene, Method::event_driven, world);
    }
}

TEST_CASE("effects: swaps exchange radii, and keep energy, momentum and masses") {
    const Communicator alone = Communicator::of_this_rank();
    const TestScene scene = swapping(692);
    SceneParameters whole = scene_of(scene);
    whole.method = Method::event_driven;
    DiscSystem system(whole, scene.discs, alone, Tuning{});
    const Totals before = system.totals();
    advance_to(system, scene.steps);
    const Totals after = system.totals();
    CHECK(after.overlapping_pairs == 0);
    CHECK(after.kinetic_energy == Approx(before.kinetic_energy).epsilon(1e-12));
    CHECK(after.momentum_x == Approx(before.momentum_x).margin(1e-12));
    CHECK(after.momentum_y == Approx(before.momentum_y).margin(1e-12));
    const std::span<const double> radii = system.side_columns()[SideColumn::swapped_radius];
    std::vector<double> now(radii.begin(), radii.end()), first;
    std::size_t n_moved = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const DiscId id = system.discs()[i].id;
        const Species& began = whole.effects.species[id / 10];
        first.push_back(began.radius);
        n_moved += now[i] != began.radius;
        CHECK(system.species_table().of(id).radius == now[i]);
        CHECK(system.species_table().of(id).mass == began.mass);
    }
    std::ranges::sort(now);
    std::ranges::sort(first);
    CHECK(now == first);
    CHECK(n_moved > 100);
}

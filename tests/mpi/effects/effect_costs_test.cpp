// SPDX-License-Identifier: BSD-3-Clause
// What effects are said to have cost: each one that a scene names by itself, in a bounded time,
// whatever the scene is like.
#include <cmath>
#include <ctime>
#include <functional>
#include <vector>

#include "catch.hpp"

#include "effect_runs.hpp"
#include "scene_tools.hpp"
#include "simulation/effect_costs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr CostsOfRun short_run = {200, 1000, 1e-6, 0.02};

Scene scene_with(const std::function<void(Scene&)>& set, Method method) {
    Scene scene = scene_of(gas(200, 0.05, 0.8, 821)); // r = 0.5
    scene.method = method;
    set(scene);
    return scene;
}

void check_costs(const Scene& scene) {
    const std::vector<EffectCost> costs = effect_costs(scene, short_run);
    REQUIRE(costs.size() == 1);
    CHECK(!costs[0].name.empty());
    REQUIRE(costs[0].time_ratio);
    CHECK(*costs[0].time_ratio > 0);
    CHECK(std::isfinite(*costs[0].time_ratio));
    CHECK(costs[0].time_share >= 0);
    CHECK(costs[0].time_share < 1);
}

} // namespace

TEST_CASE("effects: each one's cost is a number") {
    const std::vector<std::function<void(Scene&)>> all_kinds = {
        [](Scene& scene) { scene.effects.contact = {ContactKind::restitution, 0.9, 0.01}; },
        [](Scene& scene) { scene.effects.contact.kind = ContactKind::none; },
        [](Scene& scene) {
            scene.effects.contact.kind = ContactKind::none, scene.radius *= 10;
        }, // no lattice of so many
        [](Scene& scene) { scene.effects.contact = {ContactKind::rough, 0.9, 0.01, 0.5, 0.3}; },
        [](Scene& scene) { scene.effects.boundaries[0] = {BoundaryKind::thermal, 1, 0.2, 0}; },
        [](Scene& scene) { scene.effects.boundaries[2].restitution = 0.5; },
        [](Scene& scene) { scene.effects.boundaries[1] = {BoundaryKind::open, 1, 0, 0}; },
        [](Scene& scene) {
            scene.effects.boundaries[1] = {BoundaryKind::moving, 1, 0, -0.5 * scene.box_size};
        },
        [](Scene& scene) {
            scene.effects.boundaries[0].kind = scene.effects.boundaries[1].kind =
                BoundaryKind::periodic;
        },
        [](Scene& scene) { scene.effects.gravity = {0, -1e-4}; },
        [](Scene& scene) { scene.effects.drag = 1e-4; },
        [](Scene& scene) { scene.effects.obstacles = {{{7, 7, 0.5}}, {{1, 2, 9, 2}}, 0.8}; },
        [](Scene& scene) { scene.effects.species = {{100, 1.0, 1.0}, {100, 0.9, 4.0}}; },
        [](Scene& scene) {
            scene.effects.species = {{1, 2 * scene.radius, 100}, {199, scene.radius, 1}},
            scene.radius *= 2;
        }};
    for (const Method method : {Method::time_stepped, Method::event_driven})
        for (const auto& set : all_kinds) check_costs(scene_with(set, method));
}

// Beyond what timing scatters by: a forest of obstacles is looked through by each disc in each
// step, a wall's restitution by next to none.
TEST_CASE("effects: what costs much is told from what costs little") {
    const auto set = [](Scene& scene) {
        for (double x = 1; x < scene.box_size; x += 2.5)
            for (double y = 1; y < scene.box_size; y += 2.5)
                scene.effects.obstacles.discs.push_back({x, y, 0.1});
        scene.effects.boundaries[2].restitution = 0.999;
    };
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        const std::vector<EffectCost> costs = effect_costs(scene_with(set, method),
                                                           {200, 1000, 1e-6, 0.1});
        REQUIRE(costs.size() == 2);
        CHECK(costs[1].time_share > 0.1);
        CHECK(costs[1].time_share > 2 * costs[0].time_share);
        CHECK(costs[0].time_share + costs[1].time_share < 1);
    }
}

TEST_CASE("effects: a sample that would take too long is left out") {
    const Scene scene = scene_with([](Scene& all) { all.effects.contact.kind = ContactKind::none; },
                                   Method::time_stepped);
    const std::vector<EffectCost> slow = effect_costs(
        scene, {200, 1000, 1, 0.1}); // a second per disc and step
    REQUIRE(slow.size() == 1);
    CHECK(!slow[0].time_ratio);
    const std::vector<EffectCost> fast_discs = effect_costs(
        scene, {200, 1e12, 1e-6, 0.1}); // through the box a thousand times from sync to sync
    CHECK(!fast_discs[0].time_ratio);
}

// Where the run was cheap, its sample need not be: discs that do not meet beside dense ones that
// do, no step at all, most discs gone.
TEST_CASE("effects: a sample keeps to its time, whatever the run was like") {
    const auto seconds_of = [](const Scene& scene, const CostsOfRun& run) {
        const std::clock_t begin = std::clock();
        effect_costs(scene, run);
        return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    };
    constexpr double limit = 2; // seconds of this process, and 0.05 are asked for: far above what a
                                // slow machine makes of that
    const auto cascade = [](Scene& scene) {
        scene.n_discs = 3000;
        scene.box_size = 2 * scene.radius * std::sqrt(3000.0) * 0.93; // packing 0.9
        scene.effects.contact.kind = ContactKind::none;
    };
    const auto sizes = [](Scene& scene) {
        scene.n_discs = 40;
        scene.box_size = 21 * scene.radius;
        scene.effects.species = {{30, scene.radius, 0.01}, {10, 0.5 * scene.radius, 100}};
    };
    for (const Method method : {Method::time_stepped, Method::event_driven})
        for (const double energy : {1e3, 1e6, 1e9}) {
            CHECK(seconds_of(scene_with(cascade, method), {3000, energy, 1e-9, 0.05}) < limit);
            CHECK(seconds_of(scene_with(sizes, method), {40, energy, 1e-6, 0.05}) < limit);
            CHECK(seconds_of(scene_with(
                                 [](Scene& scene) {
                                     scene.effects.boundaries[0].kind = BoundaryKind::open;
                                 },
                                 method),
                             {1, energy, 1e-9, 0.05}) < limit);
        }
}

TEST_CASE("effects: large scenes are sampled, spins and many classes counted in bytes") {
    Scene scene = scene_with(
        [](Scene& all) { all.effects.contact = {ContactKind::rough, 0.9, 0.01, 0.5, 0.3}; },
        Method::time_stepped);
    scene.n_discs = 1000000;
    scene.box_size *= std::sqrt(5000.0);
    for (int k = 0; k < 10; ++k) scene.effects.species.push_back({100000, scene.radius, 1.0 + k});
    CostsOfRun run = short_run;
    run.n_discs = scene.n_discs;
    const std::vector<EffectCost> costs = effect_costs(scene, run);
    REQUIRE(costs.size() == 2);
    CHECK(costs[0].time_ratio.has_value());
    CHECK(costs[0].bytes_per_disc == 8);
    CHECK(costs[1].time_ratio.has_value());
    CHECK(costs[1].bytes_per_disc == 16);
}

// SPDX-License-Identifier: BSD-3-Clause
// Discs of several sizes in levels of cells have the reference's bits, in blocks with halos and in
// runs of the whole box, between walls and periodic sides, with constant and growing radii.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include <omp.h>

#include "core/state_hash.hpp"
#include "event_driven_runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Discs at random without overlaps, in a box that may be periodic along each axis.
TestScene mixture(const std::vector<Species>& species, double box_size, double speed,
                  std::uint64_t seed, bool round_x, bool round_y) {
    TestScene scene = empty_scene("mixture " + std::to_string(seed), box_size,
                                  species.front().radius, 6);
    scene.setting.effects.species = species;
    scene.setting.sync_every = 4;
    scene.setting.micro_steps = 2;
    constexpr Boundary periodic{BoundaryKind::periodic, 1, 0, 0};
    if (round_x)
        scene.setting.effects.boundaries[0] = scene.setting.effects.boundaries[1] = periodic;
    if (round_y)
        scene.setting.effects.boundaries[2] = scene.setting.effects.boundaries[3] = periodic;
    Random random(seed);
    add_species(scene, round_x, round_y, random);
    set_speeds(scene, speed, random);
    return scene;
}

/// Largest discs first. In the second mixture small discs fly several large diameters in a
/// micro-step.
std::vector<TestScene> mixtures(bool round_x, bool round_y) {
    std::vector<Species> many;
    for (int k = 0; k < 12; ++k)
        many.push_back(
            {1 + static_cast<std::uint64_t>(k), 3 * std::pow(0.7, k), 1 + 0.5 * (k % 4)});
    return {mixture({{3, 4, 16}, {100, 0.4, 0.2}}, 30, 1.5, 901, round_x, round_y),
            mixture({{1, 6, 9}, {6, 1.5, 2}, {90, 0.3, 0.1}}, 25, 9, 902, round_x, round_y),
            mixture(many, 26, 2, 903, round_x, round_y),
            mixture({{1, 3.4, 5}, {5, 0.3, 0.2}}, 9, 4, 904, round_x, round_y)};
}

template <class Dynamics>
std::string hash_of_run(const TestScene& scene, const Shape& shape, const Communicator& world) {
    EventDrivenEngine<Dynamics> engine(scene_of(scene), {dealt_discs(scene, world, 5), 0}, world,
                                       shape.tuning, shape.exact);
    const std::int64_t last = scene.steps * scene.setting.micro_steps;
    while (engine.micro_steps_done() < last) engine.advance_towards(scene.steps);
    const StateHash hash = hash_of(engine.own());
    std::array<std::uint64_t, 2> sums{hash.low, hash.high};
    world.sum(sums);
    return to_string(StateHash{sums[0], sums[1]});
}

/// Runs with many windows and blocks, with a level for each octave of sizes and with the levels
/// that the engine chooses.
template <class Dynamics> void check_levels(TestScene scene, const Communicator& world) {
    INFO(scene.name);
    const std::string expected = to_string(expected_of(scene, world, 20000000).hash);
    for (std::size_t number = 0; number < 12; ++number) {
        CAPTURE(number);
        Shape shape = shape_number(number, diameter_time(scene));
        shape.exact.parts_sizes = number % 4 != 3;
        if (number >= 8) { // one run of the whole box on one rank and thread
            shape.tuning.threads = 1;
            shape.exact.block_side.reset();
            shape.exact.halo.reset();
        }
        CHECK(hash_of_run<Dynamics>(scene, shape, world) == expected);
    }
}

} // namespace

TEST_CASE("event-driven: discs in levels of sizes have the reference's bits between walls") {
    const Communicator world = Communicator::world();
    for (const TestScene& scene : mixtures(false, false))
        check_levels<WalledMixedDynamics>(scene, world);
}

TEST_CASE("event-driven: discs in levels of sizes have the reference's bits in periodic boxes") {
    const Communicator world = Communicator::world();
    for (const bool round_y : {true, false})
        for (const TestScene& scene : mixtures(true, round_y))
            check_levels<PeriodicMixedDynamics>(scene, world);
}

TEST_CASE("event-driven: discs that grow in levels of sizes have the reference's bits") {
    const Communicator world = Communicator::world();
    for (TestScene scene : mixtures(true, true)) {
        scene.setting.effects.growth = 0.002;
        check_levels<GrowingDynamics>(scene, world);
    }
}

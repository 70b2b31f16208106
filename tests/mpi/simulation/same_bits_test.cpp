// SPDX-License-Identifier: BSD-3-Clause
// The engine against the brute-force reference, bit by bit, on every scene of the tests, for many
// windows, cells, strips and orders in memory. ctest runs this for many numbers of ranks and
// threads.
#include "core/state_hash.hpp"
#include "simulation/disc_system.hpp"

#include <cstdlib>

#include <omp.h>

#include "catch.hpp"

#include "scene_tools.hpp"
#include "scenes.hpp"
#include "shape_parts.hpp"
#include "time_stepped.hpp"

using namespace carrom;

namespace {

/// The result that every machine shape must have, computed on rank 0.
struct Expected {
    StateHash hash;
    reference::Counters counters;
};

Expected expected_of(const test::TestScene& scene, const Communicator& world) {
    Expected expected;
    if (world.is_root()) {
        reference::TimeSteppedReference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        expected = {hash_of(reference.discs()), reference.counters()};
    }
    world.broadcast(expected);
    return expected;
}

std::vector<InputDisc> share_of(const test::TestScene& scene, const Communicator& world,
                                unsigned seed) {
    return test::share_of(scene, world.rank(), world.size(), seed);
}

Totals run(const test::TestScene& scene, const Tuning& tuning, const Communicator& world,
           unsigned seed) {
    DiscSystem system(test::scene_of(scene), share_of(scene, world, seed), world, tuning);
    while (system.step() < scene.steps) system.advance_towards(scene.steps);
    return system.totals();
}

/// Settings of a run. All combinations occur in some scene, and a scene has other settings on other
/// machine shapes.
std::vector<Tuning> tunings(std::size_t scene_number, std::size_t count,
                            const Communicator& world) {
    const std::optional<double> windows[] = {std::nullopt, 1.0, 4.0, 64.0, 0.5, 0.09};
    const std::optional<double> cells[] = {std::nullopt, 1.0, 0.5, 0.26, 2.0};
    const double limits[] = {1.05, 0.0, 1e9};
    const std::optional<double> usual_speeds[] = {0.5, std::nullopt, 0.9, 0.05};
    std::vector<Tuning> list;
    for (std::size_t k = 0; k < count; ++k) {
        const auto shape = static_cast<std::size_t>(3 * world.size() + omp_get_max_threads());
        const std::size_t n = scene_number * count + k + shape;
        Tuning tuning;
        tuning.threads = omp_get_max_threads();
        tuning.discs_per_thread = 1;
        tuning.window = windows[n % 6];
        tuning.cell_width = cells[n % 5];
        tuning.usual_speed = usual_speeds[(n / 6) % 4];
        tuning.rebalance_above = limits[(n / 2) % 3];
        tuning.ranks_across = 1 + static_cast<int>((n / 4) % 3);
        list.push_back(tuning);
    }
    return list;
}

void check_against_reference(const std::vector<test::TestScene>& scenes, std::size_t n_tunings) {
    const Communicator world = Communicator::world();
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        if (test::is_left_to_others(s, test::n_sharing(world.size() * omp_get_max_threads())))
            continue;
        const test::TestScene& scene = scenes[s];
        const Expected expected = expected_of(scene, world);
        for (const Tuning& tuning : tunings(s, n_tunings, world)) {
            INFO(scene.name << ", N = " << scene.discs.size() << ", window "
                            << tuning.window.value_or(0) << ", cells "
                            << tuning.cell_width.value_or(0) << ", usual speed "
                            << tuning.usual_speed.value_or(0) << ", rebalance above "
                            << tuning.rebalance_above << ", ranks across "
                            << tuning.ranks_across.value_or(0));
            const Totals totals = run(scene, tuning, world, static_cast<unsigned>(s));
            CHECK(totals.wall_collisions == expected.counters.wall_collisions);
            CHECK(totals.pair_collisions == expected.counters.pair_collisions);
            CHECK(totals.rejected_candidates == expected.counters.rejected_candidates);
            CHECK(to_string(totals.hash) == to_string(expected.hash));
            if (scene.expected_pair_collisions)
                CHECK(totals.pair_collisions == *scene.expected_pair_collisions);
        }
    }
}

} // namespace

TEST_CASE("small scenes have the reference's bits") {
    check_against_reference(test::small_scenes(), 1);
}

TEST_CASE("scenes across many strips and windows have the reference's bits") {
    check_against_reference(test::large_scenes(), 2);
}

// SPDX-License-Identifier: BSD-3-Clause
// The event-driven engine against the event-driven reference, bit by bit, for windows over a factor
// of 30, and blocks, halos and strips of many kinds. ctest runs this for many numbers of ranks and
// threads.
#include <cmath>
#include <string>
#include <utility>

#include "catch.hpp"
#include <omp.h>

#include "core/errors.hpp"
#include "event_driven_runs.hpp"
#include "scene_tools.hpp"
#include "shape_parts.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Runs each scene in `n_shapes` ways. The reference computes about `most_predictions` predicates
/// for each scene.
void check_against_reference(const std::vector<TestScene>& scenes, std::size_t n_shapes,
                             std::size_t most_predictions) {
    const Communicator world = Communicator::world();
    const auto machine = static_cast<std::size_t>(
        world.size() + omp_get_max_threads()); // each machine shape tests other runs
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        TestScene scene = scenes[s];
        if (scene.cascades_when_event_driven || !is_wanted(scene, s)) continue;
        const EventDrivenResult expected = expected_of(scene, world, most_predictions);
        for (std::size_t k = 0; k < n_shapes; ++k) {
            const Shape shape = shape_number(s * n_shapes + k + machine, diameter_time(scene));
            INFO(scene.name << ", N = " << scene.discs.size() << ", window "
                            << shape.tuning.window.value_or(0) << ", block "
                            << shape.exact.block_side.value_or(0) << ", halo "
                            << shape.exact.halo.value_or(0) << ", rebalance above "
                            << shape.tuning.rebalance_above);
            try {
                const EventDrivenResult result = run_event_driven(scene, shape, world,
                                                                  static_cast<unsigned>(s));
                CHECK(result.wall_collisions == expected.wall_collisions);
                CHECK(result.pair_collisions == expected.pair_collisions);
                CHECK(to_string(result.hash) == to_string(expected.hash));
            } catch (const InputError& error) {
                CHECK(std::string(error.what()).find("overlap") != std::string::npos);
            }
        }
    }
}

/// Dilute, moderately dense, and dense gases of ten thousand discs, with about `n_collisions` for
/// each disc.
std::vector<TestScene> cascades(double n_collisions) {
    std::vector<TestScene> scenes;
    for (const auto& [packing, collisions_per_step] :
         // packings, and collision rates by Enskog
         {std::pair{0.1, 0.047}, {0.4, 0.36}, {0.65, 1.48}}) {
        TestScene scene = gas(10000, packing, 0.125, 3000 + scenes.size());
        scene.steps = static_cast<std::int64_t>(std::ceil(n_collisions / collisions_per_step));
        scenes.push_back(shuffled(scene, 3000));
    }
    return scenes;
}

} // namespace

TEST_CASE("exact: small scenes have the reference's bits") {
    check_against_reference(small_scenes(), shape_part() ? 1 : 2, shape_part() ? 250000 : 1000000);
}

TEST_CASE("exact: scenes across many strips and blocks have the reference's bits") {
    check_against_reference(large_scenes(), shape_part() ? 2 : 4, shape_part() ? 500000 : 20000000);
}

TEST_CASE("exact: ten thousand discs have the reference's bits after a collision each") {
    check_against_reference(cascades(1), shape_part() ? 1 : 2, 100000000);
}

TEST_CASE("exact: ten thousand discs have the reference's bits after 50 collisions each",
          "[.long]") {
    check_against_reference(cascades(50), 4, 5000000000);
}

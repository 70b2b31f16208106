// SPDX-License-Identifier: BSD-3-Clause
// The exact engine against the event-driven reference, bit for bit, for windows over a factor of 30, blocks, halos and
// strips of all kinds. ctest runs this for many numbers of ranks and threads.
#include <string>

#include <catch2/catch.hpp>

#include "carrom/core/errors.hpp"
#include "exact_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

void check_against_reference(const std::vector<TestScene>& scenes, std::size_t n_shapes) {
    const Communicator world = Communicator::world();
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        TestScene scene = scenes[s];
        if (scene.is_endless_under_all || !is_wanted(scene)) continue;
        const ExactResult expected = expected_of(scene, world);
        for (std::size_t k = 0; k < n_shapes; ++k) {
            const Shape shape = shape_number(s * n_shapes + k, diameter_time(scene));
            INFO(scene.name << ", N = " << scene.discs.size() << ", window " << shape.tuning.window.value_or(0) << ", block "
                            << shape.exact.block_side.value_or(0) << ", halo " << shape.exact.halo << ", rebalance above "
                            << shape.tuning.rebalance_above);
            try {
                const ExactResult result = run_exactly(scene, shape, world, static_cast<unsigned>(s));
                CHECK(result.wall_collisions == expected.wall_collisions);
                CHECK(result.pair_collisions == expected.pair_collisions);
                CHECK(to_string(result.hash) == to_string(expected.hash));
            } catch (const InputError& error) {
                CHECK(std::string(error.what()).find("overlap") != std::string::npos);
            }
        }
    }
}

} // namespace

TEST_CASE("exact: small scenes have the reference's bits") { check_against_reference(small_scenes(), 2); }

TEST_CASE("exact: scenes across many strips and blocks have the reference's bits") {
    check_against_reference(large_scenes(), 3);
}

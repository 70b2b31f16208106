// SPDX-License-Identifier: BSD-3-Clause
// A block run may compute its ring's discs wrongly if they cannot meet an own disc. How far a disc
// can come depends on its largest speed in the window, which possibly only its owner knows
// (docs/understanding/method.md, section 8.2). In these scenes there are two discs at rest, more
// than a diameter away from a block's end on either side. Discs that the other block does not
// contain hit them, so that they meet.
#include <cstdint>
#include <string>

#include "catch.hpp"
#include "event_driven_runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Pairs of rows of discs of diameter 1 at rest that nearly touch, each pair in its own square. A
/// disc hits each row at its far end, so that the near ends fly towards each other.
TestScene rows_that_meet(std::uint64_t seed) {
    constexpr double square = 9;
    constexpr int n_squares = 5;
    Random random(seed);
    TestScene scene = empty_scene("rows that meet, seed " + std::to_string(seed),
                                  n_squares * square, 0.5, 2);
    scene.setting.sync_every = 1;
    for (int k = 0; k < n_squares * n_squares; ++k) {
        const bool is_upright = random.index(2) == 1;
        const double x_low = square * (k % n_squares), y_low = square * (k / n_squares);
        const double across = random.uniform(1, square - 1);
        double along = random.uniform(0.6, 1.2);
        const auto add = [&](double velocity, double distance_to_next) {
            if (is_upright)
                add_disc(scene, x_low + across, y_low + along, 0, velocity);
            else
                add_disc(scene, x_low + along, y_low + across, velocity, 0);
            along += distance_to_next;
        };
        constexpr double touching = 1.002;
        const std::size_t n_first = 1 + random.index(3), n_second = 4 - n_first;
        add(random.uniform(0.5, 0.6), touching);
        for (std::size_t i = 1; i < n_first; ++i) add(0, touching);
        add(0, random.uniform(2, 2.08));
        for (std::size_t i = 0; i < n_second; ++i) add(0, touching);
        add(-random.uniform(0.5, 0.6), 0);
    }
    return shuffled(scene, seed);
}

} // namespace

TEST_CASE("exact: discs of the ring that are wrong count if they can meet an own disc") {
    const Communicator world = Communicator::world();
    for (std::uint64_t seed = 1; seed <= 80; ++seed) {
        TestScene scene = rows_that_meet(seed);
        const EventDrivenResult expected = expected_of(scene, world, 3000000);
        CHECK(expected.pair_collisions > 0);
        const Shape shape = small_blocks(1, 1, 1);
        INFO(scene.name);
        CHECK(run_event_driven(scene, shape, world, 1) == expected);
    }
}

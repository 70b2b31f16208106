// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven/block_window.hpp"

#include <cmath>

#include "catch.hpp"

using namespace carrom;

TEST_CASE("exact window: blocks look further while replays are repeated, then windows get shorter, "
          "and both come back") {
    Caution caution;
    for (int k = 0; k < 1000; ++k)
        // repeating a hundredth of the runs costs less than one more reach
        caution.learn({0.5, k % 20 == 0 ? 0.2 : 0});
    CHECK(caution.more_halo() == 0);
    CHECK(std::isinf(caution.most_hits()));
    for (int k = 0; k < 20; ++k) caution.learn({0.5, 0.3});
    CHECK(caution.more_halo() == 2); // the caution adds at most two reaches
    CHECK(std::isinf(caution.most_hits()));
    for (int k = 0; k < 5; ++k) caution.learn({0.5, 0.9});
    CHECK(caution.more_halo() == 2);
    CHECK(caution.most_hits() == 0.7 * 0.5);
    caution.learn({0.01, 2});
    CHECK(caution.most_hits() == 0.1);
    for (int k = 0; k < 450; ++k) caution.learn({0.1});
    CHECK(caution.more_halo() == 0);
    CHECK(caution.most_hits() > 1000);
}

TEST_CASE("exact window: blocks look further if ranks wait for others for longer than that costs") {
    Caution rarely, often;
    for (int k = 0; k < 300; ++k) {
        rarely.learn({0.5, 0, k % 30 == 0 ? 1.6 : 0, 0.1}); // an average of 0.05 windows
        often.learn({0.5, 0, k % 10 == 0 ? 1.6 : 0, 0.1});  // 0.16
        CHECK(rarely.more_halo() == 0);
    }
    CHECK(often.more_halo() > 0);
}

TEST_CASE("exact window: the first window takes Enskog's collision rate") {
    // Discs of diameter 1 at kT = 1 and packing fraction 0.5. A disc has 2 n sqrt(pi) g = 7.052
    // collisions with others per time, with g = 3.125.
    BlockNeeds needs;
    needs.box = 10;
    needs.n_discs = 0.5 * 100 / (std::acos(-1) / 4);
    needs.radius = needs.equivalent_radius = 0.5;
    CHECK(std::abs(guessed_collision_rate(needs, std::sqrt(std::acos(-1) / 2)) - 7.052 / 2) <
          0.001);
}

TEST_CASE(
    "exact window: caution widens the halo that the choice would take, not one that is wanted") {
    BlockNeeds needs{100, 1, 2000, 0.1, 1, 0, std::nullopt, false};
    const int halo = choose_block_window(needs, 64, std::nullopt).halo;
    needs.more_halo = 2;
    CHECK(choose_block_window(needs, 64, std::nullopt).halo == halo + 2);
    needs.halo = 2;
    CHECK(choose_block_window(needs, 64, std::nullopt).halo == 2);
}

TEST_CASE(
    "exact window: in a thin gas a window ends long before a disc could come to most others") {
    // Measured times for 300 steps: 0.10 s with windows of 0.25, 0.17 with 0.5, 1.3 with 2 and 0.55
    // with 38.
    BlockNeeds needs;
    needs.box = 1000;
    needs.radius = needs.equivalent_radius = 0.01;
    needs.n_discs = 1000;
    needs.speed_bound = 290;
    needs.collision_rate = 0.0025;
    needs.is_one_block = true;
    const double duration = choose_block_window(needs, 64, std::nullopt).duration;
    CHECK(duration > 0.1);
    CHECK(duration < 0.5);
}

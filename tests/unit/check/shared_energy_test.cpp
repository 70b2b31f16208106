// SPDX-License-Identifier: BSD-3-Clause
#include "check/shared_energy.hpp"

#include <cmath>
#include <vector>

#include "catch.hpp"

using namespace carrom;

namespace {

using Pairs = std::vector<std::pair<DiscId, DiscId>>;

} // namespace

TEST_CASE("energy: what a cluster hands on is not a change") {
    const std::vector<SharedEnergy> discs = {{9, 1, 0.25}, {4, 2, 2.5}, {7, 0, 0.25}, {1, 3, 3}};
    CHECK(!worst_energy_change(discs, Pairs{{4, 9}, {4, 7}}));
    CHECK(!worst_energy_change({}, {}));
}

TEST_CASE("energy: discs that are not linked have nothing to hand on") {
    const std::vector<SharedEnergy> discs = {{9, 1, 0.25}, {4, 2, 2.75}, {7, 5, 5}};
    const auto change = worst_energy_change(discs, Pairs{{4, 7}});
    REQUIRE(change);
    CHECK(change->disc == 9);
    CHECK(change->share == 0.75);
    CHECK(change->bound == 64 * 0x1p-53);
}

TEST_CASE("energy: a cluster goes by its lowest disc, its bound by its discs and collisions") {
    const std::vector<SharedEnergy> discs = {{9, 1, 1}, {4, 2, 2.5}, {7, 1, 1}};
    const auto change = worst_energy_change(discs, Pairs{{7, 9}, {4, 9}, {7, 9}});
    REQUIRE(change);
    CHECK(change->disc == 4);
    CHECK(change->share == 0.125);
    CHECK(change->bound == 6 * 64 * 0x1p-53);
}

TEST_CASE("energy: rounding is within the bound, ten times as much is not") {
    for (const double error : {60.0, 700.0}) {
        const std::vector<SharedEnergy> discs = {{0, 1, 1 + error * 0x1p-53}, {1, 1, 1}};
        CHECK(worst_energy_change(discs, Pairs{{0, 1}}).has_value() == (error > 200));
    }
    // Reflections from obstacles round like collisions, and each disc counts its own.
    const SharedEnergy often{0, 1, 1 + 4000 * 0x1p-53, 0, 90},
        rarely{1, 1, 1 + 4000 * 0x1p-53, 0, 3};
    CHECK(!worst_energy_change(std::vector{often}, {}));
    const auto change = worst_energy_change(std::vector{often, rarely}, {});
    REQUIRE(change);
    CHECK(change->disc == 1);
    CHECK(change->bound == 4 * 64 * 0x1p-53);
}

TEST_CASE("energy: out of nothing is an infinite change") {
    const auto change = worst_energy_change(std::vector<SharedEnergy>{{3, 0, 1}}, {});
    REQUIRE(change);
    CHECK(std::isinf(change->share));
}

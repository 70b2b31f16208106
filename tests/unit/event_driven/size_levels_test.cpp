// SPDX-License-Identifier: BSD-3-Clause
// The sizes that share a level of cells.
#include "event_driven/size_levels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.hpp"

using namespace carrom;

namespace {

double area_of(const std::vector<Species>& species, double packing) {
    double covered = 0;
    for (const Species& one : species)
        covered += static_cast<double>(one.count) * std::numbers::pi * one.radius * one.radius;
    return covered / packing;
}

std::vector<SizeLevel> levels_of(const std::vector<Species>& species) {
    double n = 0;
    for (const Species& one : species) n += static_cast<double>(one.count);
    return choose_size_levels(species, 0, n, area_of(species, 0.4));
}

/// Two species that cover equal areas; discs of one are `ratio` times as large.
std::vector<Species> mixture(double ratio) {
    const double n_large = std::max(1.0, std::round(10000 / (ratio * ratio + 1)));
    return {{static_cast<std::uint64_t>(n_large), ratio, 1},
            {static_cast<std::uint64_t>(10000 - n_large), 1, 1}};
}

} // namespace

TEST_CASE("size levels: equal discs have one, and so have discs that differ little") {
    const std::vector<SizeLevel> equal = choose_size_levels({}, 0.7, 100, 1000);
    REQUIRE(equal.size() == 1);
    CHECK(equal[0].largest_radius == 0.7);
    CHECK(equal[0].smallest_radius == 0.7);
    CHECK(equivalent_radius(equal) == 0.7);
    std::vector<Species> narrow;
    for (int k = 0; k < 100; ++k) narrow.push_back({100, 0.75 + 0.005 * k, 1});
    CHECK(levels_of(narrow).size() == 1);
}

TEST_CASE("size levels: large discs among small ones have their own, and each radius is in one") {
    for (const double ratio : {6.0, 10.0, 30.0, 300.0}) {
        const std::vector<SizeLevel> levels = levels_of(mixture(ratio));
        REQUIRE(levels.size() == 2);
        CHECK(levels[0].largest_radius == 1);
        CHECK(levels[1].smallest_radius == ratio);
        CHECK(level_of(1, levels) == 0);
        CHECK(level_of(ratio, levels) == 1);
        CHECK(equivalent_radius(levels) < 2);
    }
    std::vector<Species> wide; // radii over seven octaves
    for (int k = 0; k < 128; ++k) wide.push_back({std::uint64_t{1} << (14 - k / 9), 1.0 + k, 1});
    for (const bool is_each_octave : {false, true}) {
        const std::vector<SizeLevel> levels = choose_size_levels(wide, 0, 1e5, 1e8, is_each_octave);
        CHECK(levels.size() > 1);
        double n = 0;
        for (std::size_t k = 0; k < levels.size(); ++k) {
            CHECK(levels[k].smallest_radius <= levels[k].largest_radius);
            if (k > 0) CHECK(levels[k - 1].largest_radius < levels[k].smallest_radius);
            n += levels[k].n_discs;
        }
        double n_all = 0;
        for (const Species& one : wide) {
            n_all += static_cast<double>(one.count);
            const SizeLevel& level = levels[level_of(one.radius, levels)];
            CHECK(one.radius >= level.smallest_radius);
            CHECK(one.radius <= level.largest_radius);
        }
        CHECK(n == n_all);
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Bounds on places against a look at every disc, while discs move, leave, come and are put in order.
#include "carrom/domain/place_bounds.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

using carrom::Disc;
using carrom::PlaceBounds;
using carrom::PlaceRange;

namespace {

std::size_t n_places_in(const std::vector<PlaceRange>& ranges) {
    std::size_t n = 0;
    for (const PlaceRange range : ranges) n += range.end - range.begin;
    return n;
}

/// Ascending, apart, within the list, and with every disc that is outside.
void check_ranges(const std::vector<PlaceRange>& ranges, const std::vector<Disc>& discs, double low, double high) {
    std::vector<bool> is_listed(discs.size(), false);
    std::size_t end = 0;
    for (const PlaceRange range : ranges) {
        REQUIRE((range.begin >= end && range.begin < range.end && range.end <= discs.size()));
        end = range.end;
        std::fill(is_listed.begin() + static_cast<std::ptrdiff_t>(range.begin), is_listed.begin() + static_cast<std::ptrdiff_t>(range.end), true);
    }
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const bool is_outside = !(discs[i].x >= low && discs[i].x < high);
        REQUIRE((!is_outside || is_listed[i]));
    }
}

std::vector<Disc> discs_along(std::mt19937& random, std::size_t n, double length) {
    std::uniform_real_distribution<double> anywhere(0, length);
    std::vector<Disc> discs(n);
    for (Disc& disc : discs) disc.x = anywhere(random);
    return discs;
}

void put_in_order(std::vector<Disc>& discs) {
    std::sort(discs.begin(), discs.end(), [](const Disc& a, const Disc& b) { return a.x < b.x; });
}

} // namespace

TEST_CASE("no disc outside is overlooked while discs move, leave and come") {
    std::mt19937 random(7);
    const double length = 100, low = 10, high = 90;
    std::vector<Disc> discs = discs_along(random, 30000, length);
    put_in_order(discs);
    PlaceBounds bounds;
    check_ranges(bounds.outside(low, high, discs.size()), discs, low, high);
    CHECK(n_places_in(bounds.outside(low, high, discs.size())) == discs.size());
    bounds.survey(discs, 0);
    for (int turn = 0; turn < 40; ++turn) {
        if (turn == 25) {
            put_in_order(discs);
            bounds.forget();
            CHECK_FALSE(bounds.are_known());
            bounds.survey(discs, 0);
        }
        const double farthest = 0.3;
        std::uniform_real_distribution<double> step(-farthest, farthest);
        for (Disc& disc : discs) disc.x += step(random);
        bounds.widen(farthest);
        check_ranges(bounds.outside(low, high, discs.size()), discs, low, high);
        const std::size_t n_before = discs.size();
        for (std::size_t i = n_before; i-- > 0;) { // as discs migrate: gaps are closed from the end
            if (discs[i].x >= low && discs[i].x < high) continue;
            discs[i] = discs.back();
            discs.pop_back();
            bounds.replace(i);
        }
        bounds.truncate(discs.size());
        check_ranges(bounds.outside(low + 5, high - 5, discs.size()), discs, low + 5, high - 5);
        const std::vector<Disc> arrived = discs_along(random, random() % 3000, length);
        discs.insert(discs.end(), arrived.begin(), arrived.end());
        check_ranges(bounds.outside(low, high, discs.size()), discs, low, high);
    }
}

TEST_CASE("few discs in order are looked at") {
    std::mt19937 random(8);
    std::vector<Disc> discs = discs_along(random, 100000, 1000);
    put_in_order(discs);
    for (Disc& disc : discs) disc.vx = 2, disc.tau = 1; // at time 3 all are 4 further
    PlaceBounds bounds;
    bounds.survey(discs, 3);
    for (Disc& disc : discs) disc.x += 4, disc.tau = 3;
    bounds.widen(10);
    const std::vector<PlaceRange> ranges = bounds.outside(50, 950, discs.size());
    check_ranges(ranges, discs, 50, 950);
    CHECK(n_places_in(ranges) < 100 * (2 * (50 + 10) + 4 * 11)); // a hundred to a length, and a thousand more at each end of a range
}

TEST_CASE("where nobody can be inside all are looked at") {
    std::mt19937 random(9);
    const std::vector<Disc> discs = discs_along(random, 5000, 10);
    PlaceBounds bounds;
    bounds.survey(discs, 0);
    CHECK(n_places_in(bounds.outside(6, 4, discs.size())) == discs.size());
    CHECK(bounds.outside(-1, 11, 0).empty());
}

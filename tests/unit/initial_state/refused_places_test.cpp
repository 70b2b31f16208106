// SPDX-License-Identifier: BSD-3-Clause
#include "initial_state/refused_places.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"

using namespace carrom;

TEST_CASE("refused places: what the map holds overlaps a disc, and it holds most of that") {
    std::mt19937 random(11);
    for (const double radius : {1.0, 0.4}) {
        RefusedPlaces map(-2, 38, 25, 0.4, 200);
        std::uniform_real_distribution<double> along(-2, 38), across(0, 25);
        std::vector<Point> placed;
        for (int k = 0; k < 60; ++k) {
            placed.push_back({along(random), across(random)});
            map.add(placed.back(), radius);
        }
        int n_overlapping = 0, n_held = 0, n_wrong = 0;
        for (int k = 0; k < 100000; ++k) {
            const Point place{along(random), across(random)};
            bool overlaps = false;
            for (const Point& disc : placed)
                overlaps = overlaps ||
                           std::hypot(disc.x - place.x, disc.y - place.y) < radius + 0.4;
            n_overlapping += overlaps;
            n_held += map.holds(place);
            n_wrong += map.holds(place) && !overlaps;
        }
        CHECK(n_wrong == 0);
        CHECK(n_held > 0.6 * n_overlapping);
        CHECK(n_held < n_overlapping);
    }
}

TEST_CASE("refused places: a map of few places finds all that is near them, and little else") {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> anywhere(-100, 900);
    NearFew near(50, 2.0);
    std::vector<Point> points;
    for (int k = 0; k < 50; ++k) {
        points.push_back({anywhere(random), anywhere(random)});
        near.add(points.back());
        for (const double angle : {0.1, 2.0, 4.0})
            CHECK(near.may_be_near({points.back().x + 1.999 * std::cos(angle),
                                    points.back().y + 1.999 * std::sin(angle)}));
    }
    int n_near = 0;
    for (int k = 0; k < 10000; ++k)
        n_near += near.may_be_near({anywhere(random), anywhere(random)});
    CHECK(n_near < 2000);
}

// SPDX-License-Identifier: BSD-3-Clause
// Lattices: all discs are in the box and none overlap, shaken or not, up to a packing of 0.9.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/disc_state.hpp"
#include "core/state_hash.hpp"
#include "lattices/lattice.hpp"

using namespace carrom;

namespace {

constexpr double pi = 3.14159265358979323846;

/// The smallest distance of two points, by a sweep along x.
double nearest(std::vector<Point> points, double at_most) {
    std::sort(points.begin(), points.end(), [](Point a, Point b) { return a.x < b.x; });
    double least = at_most;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size() && points[j].x - points[i].x < least; ++j)
            least = std::min(least,
                             std::hypot(points[j].x - points[i].x, points[j].y - points[i].y));
    return least;
}

double radius_of(std::uint64_t n, double box, double packing) {
    return box * std::sqrt(packing / (static_cast<double>(n) * pi));
}

void check_lattice(std::uint64_t n, double box, double radius) {
    CAPTURE(n, radius);
    const auto lattice = widest_lattice(n, box, radius);
    REQUIRE(lattice.has_value());
    std::vector<Point> sites, places;
    double least = box, largest = 0;
    for (DiscId id = 0; id < n; ++id) {
        sites.push_back(lattice_site(*lattice, id));
        places.push_back(shaken_site(*lattice, id, 3210));
        for (const double c : {places.back().x, places.back().y}) {
            least = std::min(least, c);
            largest = std::max(largest, c);
        }
    }
    const double ulp = 0x1p-52 * box;
    CHECK(least >= radius - ulp);
    CHECK(largest <= box - radius + ulp);
    CHECK(nearest(sites, box) >= 2 * radius + 2 * lattice->free_radius - 4 * ulp);
    CHECK(nearest(places, box) >= 2 * radius - 4 * ulp);
}

} // namespace

TEST_CASE("lattices at packings 0.7, 0.85 and 0.9 neither overlap nor leave the box") {
    check_lattice(1000, 10, radius_of(1000, 10, 0.7));
    check_lattice(20000, 1, radius_of(20000, 1, 0.7));
    check_lattice(20000, 1e6, radius_of(20000, 1e6, 0.85));
    check_lattice(100000, 3, radius_of(100000, 3, 0.9));
}

TEST_CASE("lattices of few discs are sound too") {
    for (std::uint64_t n = 1; n < 200; ++n) {
        check_lattice(n, 10, radius_of(n, 10, 0.3));
        if (n > 12) check_lattice(n, 10, radius_of(n, 10, 0.6));
    }
}

TEST_CASE("four discs sit in a square, one in the middle") {
    const auto four = widest_lattice(4, 10, 1);
    REQUIRE(four.has_value());
    CHECK(four->free_radius == Approx(1.5));
    CHECK(lattice_site(*four, 0).x == Approx(2.5));
    CHECK(lattice_site(*four, 3).y == Approx(7.5));
    const auto one = widest_lattice(1, 10, 1);
    REQUIRE(one.has_value());
    CHECK(one->free_radius == Approx(4));
    CHECK(lattice_site(*one, 0) == Point{5, 5});
    CHECK(widest_lattice(1, 10, 5).has_value());
}

TEST_CASE("where no lattice fits there is none") {
    CHECK_FALSE(widest_lattice(50, 10, radius_of(50, 10, 0.9)).has_value());
    CHECK_FALSE(widest_lattice(2, 10, 4).has_value());
    CHECK_FALSE(widest_lattice(100000, 3, radius_of(100000, 3, 0.9068)).has_value());
}

TEST_CASE("shaking fills the free radius evenly") {
    const auto lattice = widest_lattice(10000, 100, 0.2);
    REQUIRE(lattice.has_value());
    double x = 0, y = 0, square = 0;
    const double n = 10000;
    for (DiscId id = 0; id < 10000; ++id) {
        const Point site = lattice_site(*lattice, id), place = shaken_site(*lattice, id, 1);
        const double dx = (place.x - site.x) / lattice->free_radius,
                     dy = (place.y - site.y) / lattice->free_radius;
        x += dx / n;
        y += dy / n;
        square += (dx * dx + dy * dy) / n;
    }
    CHECK(std::fabs(x) < 4 * 0.5 / 100);
    CHECK(std::fabs(y) < 4 * 0.5 / 100);
    // The squared distance is uniform if points are uniform in a disc.
    CHECK(std::fabs(square - 0.5) < 4 * std::sqrt(1.0 / 12) / 100);
}

TEST_CASE("the default seed's lattice stays what it is") {
    const auto lattice = widest_lattice(1000, 64, radius_of(1000, 64, 0.7));
    REQUIRE(lattice.has_value());
    StateHash hash;
    for (DiscId id = 0; id < 1000; ++id) {
        const Point place = shaken_site(*lattice, id, 3210);
        hash += hash_of(DiscState{place.x, place.y, 0, 0, 0, id});
    }
    CHECK(to_string(hash) == "dca302a17e96e762b7ab98322419da8d");
}

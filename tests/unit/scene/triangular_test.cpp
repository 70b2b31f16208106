// SPDX-License-Identifier: BSD-3-Clause
// The triangular lattice of a periodic box: six nearest neighbours of each site, also through the
// seams; boxes without such a lattice, and the scene that a message suggests instead.
#include "toml_scenes.hpp"

#include <numbers>

#include <fmt/format.h>

#include "lattices/triangular.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double row_height = 0.866025403784438647;

std::string periodic_scene(std::uint64_t n, const std::string& size, double radius) {
    std::string text = fmt::format("[box]\nsize = {}\n[discs]\ngenerator = \"triangular\"\n"
                                   "count = {}\nradius = {}\n[time]\nsteps = 1\n",
                                   size, n, radius);
    for (const char* side : {"left", "right", "bottom", "top"})
        text += fmt::format("[box.{}]\nkind = \"periodic\"\n", side);
    return text;
}

/// The smallest and the largest number of sites within 1.01 spacings of a site, images included.
std::pair<int, int> neighbours_of(const TriangularLattice& lattice, const Box& box) {
    const std::uint64_t n = lattice.columns * lattice.rows;
    std::pair<int, int> range{1000, 0};
    for (std::uint64_t i = 0; i < n; ++i) {
        int count = 0;
        for (std::uint64_t k = 0; k < n; ++k) {
            const Point a = lattice.site(i), b = lattice.site(k);
            for (const int x : {-1, 0, 1})
                for (const int y : {-1, 0, 1}) {
                    const double distance = std::hypot(b.x - a.x + x * box.x,
                                                       b.y - a.y + y * box.y);
                    count += distance > 0 && distance < 1.01 * lattice.spacing;
                }
        }
        range = {std::min(range.first, count), std::max(range.second, count)};
    }
    return range;
}

} // namespace

TEST_CASE("each site of a triangular lattice has six neighbours") {
    for (const auto& [columns, rows] : {std::pair(4, 4), {5, 6}, {12, 4}, {3, 20}, {29, 30}}) {
        for (const double spacing : {1.0, 2.7}) {
            const Box lying(columns * spacing, rows * spacing * row_height);
            for (const Box& box : {lying, Box(lying.y, lying.x)}) {
                const auto n = static_cast<std::uint64_t>(columns) * static_cast<unsigned>(rows);
                INFO(columns << " x " << rows << " in " << box.x << " x " << box.y);
                const auto lattice = triangular_lattice(n, box);
                REQUIRE(lattice);
                CHECK(lattice->columns == static_cast<std::uint64_t>(columns));
                CHECK(lattice->rows == static_cast<std::uint64_t>(rows));
                CHECK(lattice->nearest() == Approx(spacing).epsilon(1e-12));
                CHECK(neighbours_of(*lattice, box) == std::pair(6, 6));
                for (std::uint64_t id = 0; id < n; ++id) {
                    const Point site = lattice->site(id);
                    const bool is_inside = site.x > 0 && site.x < box.x && site.y > 0 &&
                                           site.y < box.y;
                    CHECK(is_inside);
                }
            }
        }
    }
}

TEST_CASE("a triangular lattice fits edges of five digits, and not another shape") {
    CHECK(triangular_lattice(870, {29, 25.981}));
    CHECK(triangular_lattice(870, {29, 25.9831}));
    CHECK_FALSE(triangular_lattice(870, {29, 25.99}));
    CHECK_FALSE(triangular_lattice(870, 29));
    CHECK_FALSE(triangular_lattice(29 * 31, {29, 31 * row_height})); // an odd number of rows
    CHECK_FALSE(triangular_lattice(871, {29, 30 * row_height}));
    CHECK(triangular_lattice(10000 * 11548ull, {10000, 11548 * row_height})->rows == 11548);
}

TEST_CASE("a box that no triangular lattice fits gets the nearest one that does") {
    for (const auto& [n, box] : {std::pair(870u, Box(29)),
                                 {100u, Box(10, 10)},
                                 {1u, Box(3, 2)},
                                 {7u, Box(100, 5)},
                                 {5000u, Box(40, 90)},
                                 {871u, Box(29, 26)}}) {
        const std::string text = nearest_triangular(n, box);
        unsigned long long count = 0, columns = 0, rows = 0;
        double x = 0, y = 0;
        REQUIRE(std::sscanf(text.c_str(), "discs.count = %llu, box.size = [%lf, %lf] (%llu x %llu)",
                            &count, &x, &y, &columns, &rows) == 5);
        INFO(n << " in " << box.x << " x " << box.y << ": " << text);
        const auto lattice = triangular_lattice(count, {x, y});
        REQUIRE(lattice);
        CHECK(lattice->columns == columns);
        CHECK(lattice->rows == rows);
        CHECK(std::max(x, y) / std::min(x, y) <
              3.5 * std::max(box.longest() / box.shortest(), 1.0));
        if (n >= 100) CHECK(std::fabs(static_cast<double>(count) / n - 1) < 0.1);
    }
}

TEST_CASE("scenes of triangular lattices") {
    const SceneParameters scene = read_scene(periodic_scene(120, "[10, 10.3923]", 0.49), "s.toml");
    CHECK(scene.generator == Generator::triangular);
    CHECK(mentions(problems_in(periodic_scene(120, "10", 0.4)),
                   "no triangular lattice of 120 discs fits a box of side 10: columns times an "
                   "even number of rows, with edges in the ratio of columns to rows sqrt(3) / 2; "
                   "nearest: discs.count = "));
    CHECK(mentions(problems_in(periodic_scene(120, "[10, 10.3930]", 0.50001)),
                   "discs of radius 0.50001 overlap on the triangular lattice of 10 x 12 sites"));
    const std::vector<Problem> walled = problems_in(periodic_scene(120, "10", 0.4),
                                                    {"box.left.kind=wall", "box.right.kind=wall"});
    CHECK(walled.size() == 1);
    CHECK(mentions(walled, "make all four periodic"));
    const double touching =
        read_scene(periodic_scene(120, "[10, 10.392304845413264]", 0.5), "s.toml").packing();
    CHECK(touching == Approx(std::numbers::pi * std::numbers::sqrt3 / 6).epsilon(1e-9));
}

// SPDX-License-Identifier: BSD-3-Clause
// Scenes whose box is a rectangle: their text, their errors, their lattices.
#include "toml_scenes.hpp"

#include <numbers>

#include "lattices/lattice.hpp"
#include "scene/compare.hpp"
#include "scene/key.hpp"
#include "scene/toml_text.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// The text of the problem if there is exactly one, at the right place; otherwise the number of
/// problems or the wrong place. It contains no CHECK, because it is called within one.
std::string problem_of_size(const std::string& value, const Texts& overrides = {}) {
    const std::vector<Problem> problems = problems_in(with_line(2, "size = " + value), overrides);
    if (problems.size() != 1) return std::to_string(problems.size()) + " problems";
    const Texts place = {overrides.empty() ? "s.toml:2" : "--set box.size"};
    return places_of(problems) == place ? problems.front().text : problems.front().place;
}

double nearest_distance(const std::vector<Point>& sites) {
    double nearest = 1e300;
    for (std::size_t i = 0; i < sites.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            nearest = std::min(nearest,
                               std::hypot(sites[i].x - sites[k].x, sites[i].y - sites[k].y));
    return nearest;
}

} // namespace

TEST_CASE("a box is a square of one length or a rectangle of two") {
    CHECK(read_scene(with_line(2, "size = [30, 20.5]"), "s.toml").box == Box(30, 20.5));
    CHECK(read_scene(with_line(2, "size = [30, 30]"), "s.toml").box == Box(30));
    CHECK(read_scene(good, "s.toml", {"box.size=[20, 80]"}).box == Box(20, 80));
    CHECK(read_scene(with_line(2, "size = [20, 80]"), "s.toml", {"box.size=40"}).box == Box(40));
    const SceneParameters wide = read_scene(with_line(2, "size = [50, 20]"), "s.toml");
    CHECK(wide.packing() == Approx(50 * std::numbers::pi / 1000));
    const std::string packed = "[box]\nsize = [50, 20]\n[discs]\ncount = 10\npacking = 0.25\n"
                               "[time]\nsteps = 1\n";
    CHECK(read_scene(packed, "s.toml").radius == Approx(std::sqrt(250 / (10 * std::numbers::pi))));
}

TEST_CASE("what is no box gets one line with the key and what is accepted") {
    const std::string accepted = "'box.size' must be a number from 2^-230 to 2^250, or two, "
                                 "[Lx, Ly], not ";
    CHECK(problem_of_size("[1]") == accepted + "an array of 1");
    CHECK(problem_of_size("[]") == accepted + "an array of 0");
    CHECK(problem_of_size("[1, 2, 3]") == accepted + "an array of 3");
    CHECK(problem_of_size("\"wide\"") == accepted + "'wide'");
    CHECK(problem_of_size("[40, \"wide\"]") == accepted + "[..., 'wide', ...]");
    CHECK(problem_of_size("[40, [1]]") == accepted + "[..., an array, ...]");
    CHECK(problem_of_size("{x = 40, y = 20}") == accepted + "a table");
    CHECK(problem_of_size("[40, -20]") == "'box.size' must be from 2^-230 to 2^250, not -20");
    CHECK(problem_of_size("[0, 20]") == "'box.size' must be from 2^-230 to 2^250, not 0");
    CHECK(problem_of_size("[40, nan]") == accepted + "[..., a number, ...]");
    CHECK(problem_of_size("40", {"box.size=[20]"}) == accepted + "an array of 1");
}

TEST_CASE("discs and periodic sides must fit along both edges") {
    CHECK(mentions(problems_in(with_line(2, "size = [1000, 1.9]")),
                   "a disc of radius 1 does not fit into a box of sides 1000 and 1.9"));
    const Texts round_y = {"box.bottom.kind=periodic", "box.top.kind=periodic"},
                round_x = {"box.left.kind=periodic", "box.right.kind=periodic"};
    CHECK(mentions(problems_in(with_line(2, "size = [1000, 3.9]"), round_y),
                   "a box of side 3.9 is too small to be periodic: it must be at least 4.000004"));
    CHECK(problems_in(with_line(2, "size = [1000, 3.9]"), round_x).empty());
    CHECK(problems_in(with_line(2, "size = [1000, 2]"), round_x).empty());
    CHECK(mentions(problems_in(with_line(2, "size = [30, 20]"), {"discs.list=[[25, 15, 0, 0], "
                                                                 "[15, 25, 0, 0]]",
                                                                 "discs.count=2"}),
                   "disc 1 at (15, 25) is not inside the box: centres lie between r = 1 and "
                   "Lx - r = 29 along x, Ly - r = 19 along y"));
    CHECK(mentions(problems_in(with_line(2, "size = [30, 20]"), {"discs.generator=legacy"}),
                   "the course program's box is a square"));
}

TEST_CASE("a rectangle's text is read as it is written, and tells boxes apart") {
    const SceneParameters wide = read_scene(with_line(2, "size = [50, 20.25]"), "s.toml"),
                          square = read_scene(good, "s.toml");
    const Key& key = *find_key("box.size");
    CHECK(toml_text(key, key.get(wide)) == "[50, 20.25]");
    CHECK(toml_text(key, key.get(square)) == "100");
    CHECK(read_scene(good, "s.toml", {"box.size=" + toml_text(key, key.get(wide))}).box ==
          wide.box);
    CHECK(physical_differences(wide, square) ==
          Texts{"'box.size' is [50, 20.25] there and 100 here"});
    CHECK(physical_differences(wide, wide).empty());
}

TEST_CASE("lattices in rectangles keep their gaps to walls and to each other") {
    for (const Box& box : {Box(100, 20), Box(20, 100), Box(300, 4.5), Box(31, 30), Box(500, 2.1)}) {
        for (const std::uint64_t n : {1u, 7u, 40u, 60u}) {
            const double radius = 1;
            const auto lattice = widest_lattice(n, box, radius);
            INFO(box.x << " x " << box.y << ", " << n << " discs");
            REQUIRE(lattice);
            const double s = lattice->free_radius;
            std::vector<Point> sites;
            for (std::uint64_t id = 0; id < n; ++id) sites.push_back(lattice_site(*lattice, id));
            for (const Point& site : sites) {
                CHECK(std::min(site.x, box.x - site.x) >= radius + s - 1e-9);
                CHECK(std::min(site.y, box.y - site.y) >= radius + s - 1e-9);
            }
            CHECK(nearest_distance(sites) >= 2 * (radius + s) - 1e-9);
            const bool is_bound_by_discs = radius + s < box.shortest() / 2 - 1e-9;
            if (n > 1 && lattice->n_sites() == n && is_bound_by_discs) // no lattice has a wider gap
                CHECK(nearest_distance(sites) < 2 * (radius + s) + 1e-6);
            const auto turned_over = widest_lattice(n, {box.y, box.x}, radius);
            for (std::uint64_t id = 0; id < n; ++id) {
                const Point a = shaken_site(*lattice, id, 5), b = shaken_site(*turned_over, id, 5);
                CHECK((a.x == b.y && a.y == b.x));
            }
        }
    }
    CHECK_FALSE(widest_lattice(51, {100, 2}, 1));
    CHECK(widest_lattice(50, {100, 2}, 1));
}

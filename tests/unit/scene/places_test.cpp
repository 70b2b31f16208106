// SPDX-License-Identifier: BSD-3-Clause
// The numbers of scenes that are places, and their conversion between the coordinates of users and
// those of the computation.
#include "catch.hpp"

#include <cmath>
#include <random>
#include <set>
#include <string>

#include "problems_of.hpp"
#include "scene/places.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_text.hpp"

using namespace carrom;
using test::mentions;
using test::problems_of;

namespace {

const std::string rest = "[time]\nsteps = 1\n[discs]\n", equal = rest + "radius = 1\n";

SceneParameters scene_of(const std::string& origin, const std::string& more) {
    return read_scene("[box]\nsize = [20, 10]\norigin = " + origin + "\n" + rest + more, "s.toml");
}

bool has(const std::string& text, std::string_view part) {
    UNSCOPED_INFO(text);
    return text.find(part) != std::string::npos;
}

/// "xyxy.." for the first six numbers of a key's rows.
std::string axes_of(std::string_view name) {
    std::string text;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto axis = axis_of(*find_key(name), k);
        text += !axis ? '.' : *axis == Axis::x ? 'x' : 'y';
    }
    return text;
}

} // namespace

TEST_CASE("The keys of places are known, so that a new one is no accident") {
    std::set<std::string> names;
    for (const Key& key : keys())
        if (has_places(key)) names.insert(key.name);
    CHECK(names == std::set<std::string>{"discs.freeze", "discs.groups", "discs.list",
                                         "discs.region", "discs.species", "discs.streams",
                                         "effects.field.centre_x", "effects.field.centre_y",
                                         "effects.obstacles.arcs", "effects.obstacles.discs",
                                         "effects.obstacles.polygons",
                                         "effects.obstacles.segments"});
    CHECK(axes_of("discs.list") == "xy....");
    CHECK(axes_of("discs.streams") == "xyxy..");
    CHECK(axes_of("effects.obstacles.discs") == "xy....");
    CHECK(axes_of("effects.obstacles.arcs") == "xy....");
    CHECK(axes_of("effects.obstacles.polygons") == "xyxyxy");
    CHECK(axis_of(*find_key("effects.obstacles.polygons"), 1001) == Axis::y);
    CHECK(axes_of("effects.field.centre_y") == "y.....");
    CHECK(axes_of("box.size") == "......");
    CHECK(axes_of("discs.frozen") == "......");
}

TEST_CASE("Places are taken from the corner, whatever the order of keys") {
    const SceneParameters scene = scene_of(
        "\"centre\"",
        "radius = 1\nlist = [[-9, 4, 0.5, -1]]\n[effects.obstacles]\ndiscs = [[1, -2, 0.5]]\n"
        "polygons = [[0, 0, 1, 0, 1, 1]]\n");
    CHECK(scene.origin == Origin{10, 5});
    REQUIRE(scene.listed_discs.size() == 1);
    CHECK(scene.listed_discs[0] == InputDisc{0, 1, 9, 0.5, -1});
    CHECK(scene.effects.fixed_bodies.discs[0].x == 11);
    CHECK(scene.effects.fixed_bodies.discs[0].y == 3);
    CHECK(scene.effects.fixed_bodies.discs[0].radius == 0.5);
    CHECK(scene.effects.fixed_bodies.polygons[0] == Polygon{10, 5, 11, 5, 11, 6});
    const SceneParameters later = read_scene(
        equal + "list = [[-9, 4, 0.5, -1]]\n[box]\norigin = \"centre\"\nsize = [20, 10]\n",
        "s.toml");
    CHECK(later.listed_discs == scene.listed_discs);
}

TEST_CASE("A scene with an origin is written so that it reads back as the same") {
    const SceneParameters scene = scene_of(
        "[4, 5]", "species = [{count = 2, radius = 0.5, region = [-4, -5, 3, 3]}, {count = 1, "
                  "radius = 0.25}]\n[effects.obstacles]\narcs = [[10, 0, 1], [12, 1, 1, 0, 90]]\n");
    const std::string text = scene_text(scene);
    CHECK(has(text, "origin = [4, 5]"));
    CHECK(has(text, "region = [-4, -5, 3, 3]"));
    CHECK(has(text, "[10, 0, 1]"));
    const SceneParameters again = read_scene(text, "s.toml");
    CHECK(again.regions == scene.regions);
    CHECK(scene_text(again) == text);
    CHECK(
        has(scene_text(scene_of("\"centre\"", "radius = 1\ncount = 1\n")), "origin = \"centre\""));
}

TEST_CASE("Coordinates are shown in the fewest digits that stand for them") {
    CHECK(shown_coordinate(5.1, 5) == "0.1");
    CHECK(shown_coordinate(0, 5) == "-5");
    CHECK(shown_coordinate(0.1, 0) == "0.1");
    CHECK(shown_coordinate(16.5, 0.1) == "16.4");
}

TEST_CASE("To and fro, a place is rounded once and stays as it is then") {
    std::mt19937_64 random(59);
    std::uniform_real_distribution<double> places(0, 20), origins(-40, 40);
    const Key& key = *find_key("effects.field.centre_x");
    const auto moved = [&key](double x, double by) {
        Value value{x};
        move_places(key, value, by, 0);
        return std::get<double>(value.data);
    };
    for (int i = 0; i < 100'000; ++i) {
        const double origin = origins(random), first = places(random);
        const double second = moved(moved(first, -origin), origin);
        CHECK_FALSE(std::fabs(second - first) > 0x1p-48); // one ulp of a number near 60
        const double third = moved(moved(second, -origin), origin);
        if (second != third) FAIL(first << " from " << origin);
    }
}

TEST_CASE("An origin that loses digits, or none, is refused") {
    const auto refusal = [](const std::string& origin) {
        return problems_of([&] {
            read_scene("[box]\nsize = 10\norigin = " + origin + "\n" + equal + "count = 1\n",
                       "s.toml");
        });
    };
    CHECK(mentions(refusal("[1e5, 0]"), "within 10000, 1000 edges of the box"));
    CHECK(mentions(refusal("[0, nan]"), "\"centre\", or two numbers, [x, y]"));
    CHECK(mentions(refusal("[[0, 0]]"), "not an array of 1"));
    CHECK(mentions(refusal("5"), "not a whole number"));
    CHECK(mentions(refusal("\"corner\""), "try: [0, 0]"));
}

// SPDX-License-Identifier: BSD-3-Clause
// Radii, masses and spins of each disc, from the file of discs, from rows of the list, and from
// species.
#include "catch.hpp"

#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/compare.hpp"
#include "scene/disc_columns.hpp"
#include "scene/disc_reader.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;
using test::mentions;
using test::places_of;
using test::problems_of;

namespace {

using Texts = std::vector<std::string>;

const std::string box = "[box]\nsize = 100\n[time]\nsteps = 10\n";
const std::string rough =
    "[effects.contact]\nkind = \"rough\"\nrestitution = 0.9\ntangential_restitution = 0.5\n";

std::string from_file(const std::string& columns, int n = 4) {
    return box + "[discs]\ncount = " + std::to_string(n) +
           "\nfile = \"d.txt\"\ncolumns = " + columns + '\n';
}

DiscColumns columns_of(const std::string& lines, const SceneParameters& scene) {
    std::istringstream stream(lines);
    return read_disc_columns(stream, scene);
}

/// Reads a scene as the program does: the scene, the columns that it names, and the scene again.
SceneParameters scene_with(const std::string& text, const std::string& lines) {
    const SceneParameters first = read_scene(SceneText{"s.toml", text, 0, false, {}});
    return read_scene(SceneText{"s.toml", text, 0, false, columns_of(lines, first)});
}

std::vector<Problem> problems_in(const std::string& text,
                                 const std::optional<DiscColumns>& columns = {}) {
    return problems_of([&] { read_scene(SceneText{"s.toml", text, 0, false, columns}); });
}

const std::string four_lines =
    "2 50 50 0 1 3 7\n\n0 10 10 1 0 2 5\n3 80 80 0 0 1 1\n1 20 20 0 0 2 5\n";

} // namespace

TEST_CASE(
    "columns of a file of discs are species in the order of ids, whatever the order of lines") {
    const SceneParameters scene = scene_with(from_file("[\"radius\", \"mass\"]"), four_lines);
    CHECK(scene.effects.species == std::vector<Species>{{2, 2, 5}, {1, 3, 7}, {1, 1, 1}});
    CHECK(scene.radius == 3);
    CHECK(scene.packing() == Approx(3.14159265358979 * (2 * 4 + 9 + 1) / 1e4));
    std::istringstream stream(four_lines);
    DiscReader reader(stream, scene);
    std::vector<InputDisc> discs;
    CHECK(reader.read(discs, 100));
    CHECK(reader.problems().empty());
    CHECK(discs == std::vector<InputDisc>{
                       {2, 50, 50, 0, 1}, {0, 10, 10, 1, 0}, {3, 80, 80, 0, 0}, {1, 20, 20, 0, 0}});

    const SceneParameters other = scene_with(from_file("[\"mass\", \"radius\"]"),
                                             four_lines); // numbers are in the order of the columns
    CHECK(other.effects.species == std::vector<Species>{{2, 5, 2}, {1, 7, 3}, {1, 1, 1}});
    const SceneParameters light = scene_with(from_file("[\"radius\"]", 2),
                                             "1 20 20 0 0 2\n0 10 10 1 0 4\n");
    CHECK(light.effects.species == std::vector<Species>{{1, 4, 1}, {1, 2, 1}});
    CHECK(physical_differences(scene, other).size() == 2); // species, columns
}

TEST_CASE("spins at the start come from a file, a list or species") {
    const SceneParameters file = scene_with(from_file("[\"spin\"]", 3) + "radius = 1\n" + rough,
                                            "0 10 10 1 0 0.5\n2 30 30 0 0 -2\n1 20 20 0 0 0.5\n");
    CHECK(file.effects.species.empty());
    CHECK(file.radius == 1);
    CHECK(file.first_numbers[SideColumn::spin] == std::vector<NumberRun>{{2, 0.5}, {3, -2}});
    CHECK(first_number(file, SideColumn::spin, 0) == 0.5);
    CHECK(first_number(file, SideColumn::spin, 1) == 0.5);
    CHECK(first_number(file, SideColumn::spin, 2) == -2);
    const SceneParameters list = read_scene(
        box + "[discs]\nradius = 1\nlist = [[10, 10, 1, 0], [20, 20, 0, 0, 0.25]]\n" + rough,
        "s.toml");
    CHECK(list.first_numbers[SideColumn::spin] == std::vector<NumberRun>{{1, 0}, {2, 0.25}});
    const SceneParameters all = read_scene(
        box + "[discs]\nlist = [[10, 10, 1, 0, 2, 3, 1.5], [20, 20, 0, 0, 1, 1]]\n" + rough,
        "s.toml");
    CHECK(all.effects.species == std::vector<Species>{{1, 2, 3}, {1, 1, 1}});
    CHECK(all.first_numbers[SideColumn::spin] == std::vector<NumberRun>{{1, 1.5}, {2, 0}});
    const std::string species = "[[discs.species]]\ncount = 3\nradius = 2\nspin = "
                                "-1\n[[discs.species]]\ncount = 40\nradius = 0.5\n";
    const SceneParameters kinds = read_scene(box + species + rough, "s.toml");
    CHECK(kinds.first_numbers[SideColumn::spin] == std::vector<NumberRun>{{3, -1}, {43, 0}});
    CHECK(first_number(kinds, SideColumn::spin, 2) == -1);
    CHECK(first_number(kinds, SideColumn::spin, 3) == 0);
    CHECK(read_scene(box + "[discs]\ncount = 5\nradius = 1\n" + rough, "s.toml")
              .first_numbers[SideColumn::spin]
              .empty());
    CHECK(physical_differences(
              kinds, read_scene(box +
                                    "[[discs.species]]\ncount = 3\nradius = "
                                    "2\n[[discs.species]]\ncount = 40\nradius = 0.5\n" +
                                    rough,
                                "s.toml")) == Texts{"discs begin with other spins there"});
    for (const std::string& text : {from_file("[\"spin\"]") + "radius = 1\n", box + species,
                                    box + "[discs]\nradius = 1\nlist = [[10, 10, 1, 0, 0.5]]\n"})
        CHECK(mentions(problems_in(text), "effects.contact.kind = \"rough\""));
    CHECK(mentions(problems_in(box + "[discs]\nradius = 1\nlist = [[10, 10, 1, 0, inf]]\n" + rough),
                   "row 1 of 'discs.list': the spin must be finite"));
}

TEST_CASE("wrong columns are refused where they are named") {
    const DiscColumns whole = columns_of(
        four_lines,
        read_scene(SceneText{"s.toml", from_file("[\"radius\", \"mass\"]"), 0, false, {}}));
    REQUIRE(whole.is_whole);
    CHECK(mentions(problems_in(from_file("[\"radius\", \"colour\"]"), whole),
                   "\"radius\", \"mass\", \"spin\" or \"direction\", not 'colour'"));
    CHECK(mentions(problems_in(from_file("[\"radius\", \"radius\"]"), whole),
                   "'discs.columns' has 'radius' twice"));
    CHECK(mentions(problems_in(from_file("[\"mass\"]") + "radius = 1\n"),
                   "cannot have masses in discs.columns together with columns without radii"));
    CHECK(mentions(problems_in(from_file("[\"radius\"]") + "radius = 1\n", whole),
                   "or 'discs.columns' name radii"));
    CHECK(mentions(
        problems_in(box + "[discs]\ncount = 4\nradius = 1\ncolumns = [\"spin\"]\n" + rough),
        "has no meaning without discs.generator = \"file\""));
    CHECK(mentions(
        problems_in(box + "[discs]\nlist = [[10, 10, 1, 0]]\nradius = 1\ncolumns = [\"spin\"]\n" +
                    rough),
        "'discs.list' and 'discs.columns' exclude each other"));
    CHECK(mentions(
        problems_in(from_file("[\"radius\"]") + "[[discs.species]]\ncount = 4\nradius = 1\n",
                    whole),
        "'discs.species' has no meaning where 'discs.columns'"));
    const DiscColumns wide{{{4, 60, 1}}, {}, true};
    CHECK(mentions(problems_in(from_file("[\"radius\"]"), wide), "does not fit into a box"));
}

TEST_CASE("lines with wrong columns are told by their number, with all else that is wrong") {
    const std::string text = from_file("[\"radius\", \"mass\"]", 8);
    const std::string lines =
        "0 10 10 1 0 2 5\n1 20 20 0 0 -1 5\n2 30 30 0 0 2 0\n3 40 40 0 0 nan 1\n4 50 50 0 0 2\n5 "
        "60 60 0 0 2 1 9\n6 1 70 0 0 2 1\n7 80 80 0 0 two 1\n";
    const SceneParameters scene = read_scene(SceneText{"s.toml", text, 0, false, {}});
    const DiscColumns columns = columns_of(lines, scene);
    CHECK(!columns.is_whole);
    std::vector<Problem> none;
    const SceneParameters checked = read_scene(SceneText{"s.toml", text, 0, false, columns}, {},
                                               none);
    CHECK(none.empty()); // the reader of lines reports the error
    std::istringstream stream(lines);
    const std::vector<Problem> problems = disc_line_problems(stream, checked);
    CHECK(places_of(problems) ==
          Texts{"d.txt:2", "d.txt:3", "d.txt:4", "d.txt:5", "d.txt:6", "d.txt:7", "d.txt:8"});
    CHECK(mentions(problems, "the radius must be from 2^-230 to 2^250, not -1"));
    CHECK(mentions(problems, "the mass must be from 2^-100 to 2^100, not 0"));
    CHECK(mentions(problems, "expected 'id x y vx vy radius mass', found only 6 of the 7 numbers"));
    CHECK(mentions(problems, "'9' after the 7 numbers"));
    CHECK(mentions(problems, "disc 6 at (1, 70) is not inside the box"));
    CHECK(mentions(problems, "'two' is not a number"));

    for (const char* flawed : {"0 10 10 1 0 2 5\n", "0 10 10 1 0 2 5\n0 20 20 1 0 2 5\n",
                               "0 10 10 1 0 2 5\n9 20 20 1 0 2 5\n", ""})
        CHECK(!columns_of(flawed,
                          read_scene(SceneText{
                              "s.toml", from_file("[\"radius\", \"mass\"]", 2), 0, false, {}}))
                   .is_whole);
}

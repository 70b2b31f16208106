// SPDX-License-Identifier: BSD-3-Clause
// The legacy text format: its header, the lines after it, and each kind of error.
#include "catch.hpp"

#include <sstream>
#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;
using test::places_of;
using test::problems_of;

namespace {

using Texts = std::vector<std::string>;

std::vector<Problem> problems_in(const std::string& text, const Texts& overrides = {}) {
    return problems_of([&] { read_scene(text, "t.in", overrides); });
}

} // namespace

TEST_CASE("a header alone asks for the legacy generator") {
    const SceneParameters scene = read_scene("1000\n20000\n1\n500\nperf\n", "t.in");
    CHECK(scene.n_discs == 1000);
    CHECK(scene.box.x == 20000);
    CHECK(scene.radius == 1);
    CHECK(scene.steps == 500);
    CHECK(scene.text_output == TextOutput::first_and_last);
    CHECK(scene.generator == Generator::legacy);
    CHECK(scene.method == Method::time_stepped);
    CHECK_FALSE(scene.reads_disc_lines());
    CHECK(read_scene("1\n2.0\n1e0\n0\nprint", "standard input").text_output ==
          TextOutput::every_step);
    CHECK(read_scene("\n1\r\n\n 2\t\r\n1\r\n0\r\n\r\nperf\r\n\n \n", "t.in").generator ==
          Generator::legacy);
}

TEST_CASE("lines after the header are discs, and the stream is left at the first") {
    std::istringstream stream("2\n\n10\n1\n5\nprint\n\n\n1 2 3 4 5\n0 5 5 0 0\n");
    const SceneText text = read_scene_text(stream, "t.in");
    CHECK(text.discs_follow);
    CHECK(text.lines_before_discs == 8);
    std::string rest;
    std::getline(stream, rest);
    CHECK(rest == "1 2 3 4 5");
    const SceneParameters scene = read_scene(text);
    CHECK(scene.reads_disc_lines());
    CHECK(scene.text == "2\n\n10\n1\n5\nprint\n");
    CHECK(scene.lines_before_discs == 8);
    CHECK(read_scene(text, {"discs.generator=lattice"}).generator == Generator::lattice);
}

TEST_CASE("overrides work on the legacy text format") {
    const SceneParameters scene = read_scene(
        "100\n20000\n1\n500\nperf\n", "t.in",
        {"box.size=3", "discs.packing=0.25", "time.steps=7", "output.text=none", "discs.seed=5"});
    CHECK(scene.box.x == 3);
    CHECK(scene.packing() == Approx(0.25));
    CHECK(scene.steps == 7);
    CHECK(scene.text_output == TextOutput::none);
    CHECK(scene.seed == 5);
    const std::string text = "100\n20000\n1\n500\nperf\n";
    CHECK(read_scene(text, "t.in", {"time.method=event-driven"}).method == Method::event_driven);
    CHECK(read_scene(text, "t.in", {"time.accuracy=0.1"}).accuracy == 0.1);
    CHECK(places_of(problems_in("100\n20000\n1\n500\nperf\n",
                                {"time.method=event-driven", "box.sze=1", "discs.speed=3"})) ==
          Texts{"--set box.sze", "--set discs.speed"});
}

TEST_CASE("each wrong header has its problems at their lines") {
    struct Wrong {
        std::string text;
        Texts places;
    };
    const std::vector<Wrong> all = {
        {"", {"t.in"}},
        {"\n \n\t\n", {"t.in"}},
        {"10\n", {"t.in:1"}},
        {"10\n20000\n1\n5\n", {"t.in:4"}},
        {"ten\n20000\n1\n5\nperf\n", {"t.in:1"}},
        {"10 20000\n1\n5\nperf\n", {"t.in:1", "t.in:3", "t.in:4", "t.in:4"}},
        {"0\n20000\n1\n5\nperf\n", {"t.in:1"}},
        {"-3\n20000\n1\n5\nperf\n", {"t.in:1"}},
        {"1.5\n20000\n1\n5\nperf\n", {"t.in:1"}},
        {"10000000000000000000\n20000\n1\n5\nperf\n", {"t.in:1"}},
        {"1e19\n20000\n1\n5\nperf\n", {"t.in:1"}},
        {"nan\n20000\n1\n5\nperf\n", {"t.in:1"}},
        {"10\nnan\n1\n5\nperf\n", {"t.in:2"}},
        {"10\n-inf\n1\n5\nperf\n", {"t.in:2"}},
        {"10\n1,5\n1\n5\nperf\n", {"t.in:2"}},
        {"10\n20000 km\n1\n5\nperf\n", {"t.in:2"}},
        {"10\n20000\n0\n5\nperf\n", {"t.in:3"}},
        {"10\n20000\n-1\n5\nperf\n", {"t.in:3"}},
        {"10\n20000\n10001\n5\nperf\n", {"t.in:3"}},
        {"10\n20000\n0.001\n5\nperf\n", {"t.in:3"}},
        {"10\n5.8\n1\n5\nperf\n", {"t.in:3"}},
        {"10\n20000\n1\n-1\nperf\n", {"t.in:4"}},
        {"10\n20000\n1\n5.5\nperf\n", {"t.in:4"}},
        {"10\n20000\n1\n5\nquick\n", {"t.in:5"}},
        {"10\n20000\n1\n5\nPERF\n", {"t.in:5"}},
        {"10\n20000\n1\n5\nperf now\n", {"t.in:5"}},
        {"0\nnan\n-1\n1e300\nx y\n", {"t.in:1", "t.in:2", "t.in:3", "t.in:4", "t.in:5", "t.in:5"}},
    };
    for (const Wrong& wrong : all) {
        CAPTURE(wrong.text);
        CHECK(places_of(problems_in(wrong.text)) == wrong.places);
    }
    CHECK(places_of(problems_in("1" + std::string(4999, '1'))) == Texts{"t.in:1"});
}

TEST_CASE("files that cannot be read are a problem of their own") {
    CHECK(problems_of([] { open_input("/no/such/file.in"); }).size() == 1);
    CHECK(problems_of([] { open_input("/"); }).size() == 1);
}

// SPDX-License-Identifier: BSD-3-Clause
// Texts of scenes: overrides, bounds, listed discs and streams.
#include "toml_scenes.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("an override without a key is shown as it was written") {
    CHECK(places_of(problems_in(good, {"=3"})) == Texts{"--set =3"});
    CHECK(places_of(problems_in(good, {" = 3"})) == Texts{"--set  = 3"});
}

TEST_CASE("a mark of the byte order at the start of a file is no part of it") {
    CHECK(problems_in("\xef\xbb\xbf" + good).empty());
    CHECK(read_scene("\xef\xbb\xbf"
                     "2\n10\n1\n5\nperf\n",
                     "s.in")
              .n_discs == 2);
    CHECK(read_scene("\xef\xbb\xbf\n2\n10\n1\n5\nperf\n0 3 3 0 0\n1 7 7 0 0\n", "s.in")
              .lines_before_discs == 6);
    CHECK(places_of(problems_of([] { read_scene("\xef\xbb\xbf", "s.in"); })) == Texts{"s.in"});
}

TEST_CASE("a packing or a radius that cannot be says what the bound is") {
    CHECK(mentions(problems_in(with_line(5, "packing = 0.95")),
                   "at most 0.9069, not 0.95: equal discs cover no more of the plane"));
    CHECK(mentions(problems_in(with_line(5, "radius = 1e-9"), {"time.method=time-stepped"}),
                   "discs of radius 1e-09 in a box of side 100"));
    const SceneParameters all = read_scene(with_line(5, "radius = 1e-9"), "s.toml");
    REQUIRE(all.warnings.size() == 1);
    CHECK(all.warnings[0].find("discs of radius 1e-09 in a box of side 100") == 0);
}

TEST_CASE("keys that have no say in the discs are refused") {
    CHECK(problems_in(with_line(5, "radius = 1\nfile = 'd'\nseed = 1\nvelocities = 'uniform'"))
              .size() == 2);
    CHECK(problems_in(with_line(5, "radius = 1\nfile = 'd'\nspeed = 1\nseed = 1")).empty());
    CHECK(problems_in(with_line(5, "radius = 1\ngenerator = 'legacy'\nvelocities = 'uniform'"))
              .size() == 1);
    CHECK(problems_in(with_line(5, "radius = 1\ngenerator = 'lattice'\nfile = 'd'")).size() == 1);
    CHECK(problems_in(with_line(5, "radius = 1\npacking = 0.1")).size() == 1);
    CHECK(problems_in(with_line(4, "file = 'd'\nlist = [[1, 1, 1, 1]]")).size() == 1);
}

TEST_CASE("discs listed in the scene must lie in the box and move") {
    const std::string head = "[box]\nsize = 10\n[discs]\nradius = 1\nlist = [\n";
    const std::string tail = "]\n[time]\nsteps = 1\n";
    CHECK(problems_in(head + "[1, 9, 0, 0],\n[1, 9, 0, 0]\n" + tail)
              .empty()); // discs that overlap each other and touch two walls
    CHECK(
        places_of(problems_in(
            head +
            "[0.99, 5, 0, 0],\n[5, 5, 0, 0],\n[5, 9.01, 0, 0],\n[nan, 5, 0, 0],\n[5, 5, inf, 0],\n"
            "[5, 5, 1e100, 0],\n[5, 5, 0, 1e-100],\n[5, 5, 0],\n[5, 5, 0, 0, 0],\n['a', 5, 0, "
            "0]\n" +
            tail)) == Texts{"s.toml:6", "s.toml:8", "s.toml:9", "s.toml:10", "s.toml:11",
                            "s.toml:12", "s.toml:13", "s.toml:14", "s.toml:15"});
    const auto inline_rows = problems_in(
        good, {"discs.list=[[1, 2, 3], [5, 5, inf, nan], [0, nan, 1, 0], [5, 5, 0, 0]]",
               "discs.count=4"});
    // rows of an override have no lines, so there is one problem each
    CHECK(inline_rows.size() == 3);
    CHECK(mentions(inline_rows, "row 1 of 'discs.list': three numbers; it takes [x, y]"));
    CHECK(mentions(
        inline_rows,
        "row 2 of 'discs.list': the velocity inf is not a finite number; the velocity nan is not"));
    CHECK(mentions(inline_rows, "row 3 of 'discs.list': the position nan is not"));
    CHECK(places_of(problems_in(
              "[box]\nsize = 10\n[discs]\nradius = 1\nlist = []\n[time]\nsteps = 1\n")) ==
          Texts{"s.toml:5"});
}

TEST_CASE("streams need a region and a finite velocity") {
    const std::string head = good + "[[discs.streams]]\n";
    CHECK(problems_in(head + "region = [0, 0, 1, 1]\nvelocity = [1, 2]\n").empty());
    for (const char* wrong :
         {"region = [0, 0, 1, nan]\nvelocity = [1, 2]\n",
          "region = [1, 0, 0, 1]\nvelocity = [1, 2]\n",
          "region = [0, 0, 1, 1]\nvelocity = [inf, 2]\n", "region = [0, 0, 1, 1]\nvelocity = 3\n",
          "region = [0, 0, 1, 1]\n", "velocity = [0, 1]\n",
          "region = [0, 0, 1, 1]\nvelocity = [1, 2]\nspeed = 3\n"}) {
        CAPTURE(wrong);
        CHECK(problems_in(head + wrong).size() == 1);
    }
    const auto several = problems_in(
        good, {"discs.streams=[{region=[0,0,1,1],velocity=[1,2]}, {region=[0,0,1],velocity=[1]}, "
               "{region=[3,0,1,1],velocity=[inf,2]}, {region=[0,0,1,1],speed=2}]"});
    CHECK(several.size() == 5);
    for (const char* text : {"row 2 of 'discs.streams': region must be numbers, [x0, y0, x1, y1]",
                             "row 2 of 'discs.streams': velocity must be numbers, [vx, vy]",
                             "row 3 of 'discs.streams': its region must be finite, with x0 < x1 "
                             "and y0 < y1; the velocity inf",
                             "row 4 of 'discs.streams' has no 'speed'",
                             "row 4 of 'discs.streams' needs velocity = [vx, vy]"})
        CHECK(mentions(several, text));
    CHECK(problems_in(with_line(5, "radius = 1\nstreams = 3")).size() == 1);
    CHECK(problems_in(with_line(5, "radius = 1\nstreams = [3]")).size() == 1);
}

TEST_CASE("a wrong scene keeps what its lines of discs can be held to") {
    const auto partly = [](const std::string& more) {
        std::vector<Problem> problems;
        const SceneParameters scene = read_scene(
            {"s.toml", "[time]\nsteps = -1\n[discs]\nfile = \"d\"\n" + more, 0, false}, {},
            problems);
        CHECK(problems.size() >= 1);
        CHECK(scene.reads_disc_lines());
        CHECK(scene.discs_file == "d");
        return std::vector<double>{static_cast<double>(scene.n_discs), scene.box.x, scene.radius};
    };
    CHECK(partly("count = 2\nradius = 1\n[box]\nsize = 10") == std::vector<double>{2, 10, 1});
    CHECK(partly("count = 0\nradius = 1\n[box]\nsize = 10") == std::vector<double>{0, 10, 1});
    CHECK(partly("count = 2\nradius = 8\n[box]\nsize = 10") == std::vector<double>{2, 0, 0});
    CHECK(partly("count = 2\nradius = 1\n[box]\nsize = nan") == std::vector<double>{2, 0, 0});
}

TEST_CASE("a wrong value is told though the command line replaces it") {
    CHECK(places_of(problems_in(with_line(7, "steps = -3"), {"time.steps=5"})) ==
          Texts{"s.toml:7"});
    CHECK(places_of(problems_in(with_line(7, "steps = 'ten'"), {"time.steps=-5"})) ==
          Texts{"s.toml:7", "--set time.steps"});
    CHECK(problems_in(with_line(7, "steps = 3"), {"time.steps=5"}).empty());
}

TEST_CASE("a message says what is accepted") {
    const auto says = [](const std::string& override, const std::string& text) {
        const auto problems = problems_in(good, {override});
        return problems.size() == 1 && mentions(problems, text);
    };
    CHECK(says("time.steps", "'time.steps' is not of the form key=value; its value is a whole "
                             "number from 0 to 2^53"));
    CHECK(says("time.steps=2.5", "must be a whole number from 0 to 2^53, not 2.5"));
    CHECK(says("time.steps=ten", "must be a whole number from 0 to 2^53, not 'ten'"));
    CHECK(says("time.method=event", "must be \"time-stepped\" or \"event-driven\", not 'event'"));
    CHECK(says("discs.radius=nan", "must be a number 0, or from 2^-230 to 2^250, not nan"));
    CHECK(says("box.periodic=true", "try: box.left.kind = \"periodic\""));
}

TEST_CASE("a run too short for a window of diffusion is warned of, with what would fit") {
    const auto warnings = [](Texts more) {
        more.insert(more.end(), {"output.measurements.quantities=[\"diffusion\"]",
                                 "output.measurements.every_steps=3", "output.folder=f"});
        return read_scene(good, "s.toml", more).warnings;
    };
    const auto by_default = warnings({"time.steps=40"});
    REQUIRE(by_default.size() == 1);
    CHECK(by_default[0] ==
          "no table of diffusion: its first window takes 192 steps, and from step 0 to the last "
          "one are 40; try: output.measurements.correlation_steps = 39 or less; an error takes "
          "four windows");
    CHECK(warnings({"time.steps=40", "output.measurements.correlation_steps=39"}).empty());
    CHECK(warnings({"time.steps=40", "output.measurements.correlation_steps=39",
                    "output.measurements.from_step=2"})
              .size() == 1);
    CHECK(warnings({"time.steps=192"}).empty());
    CHECK(warnings({"time.steps=0"}).empty()); // allowed: such a run prints the start
    const auto too_short = warnings({"time.steps=5"});
    REQUIRE(too_short.size() == 1);
    CHECK(too_short[0].ends_with("try: output.measurements.every_steps = 2 or less"));
}

TEST_CASE("what a warning of a short run proposes makes the warning go away") {
    const auto warnings = [](const std::string& quantity, Texts more) {
        more.insert(more.end(), {"output.measurements.quantities=[\"" + quantity + "\"]",
                                 "output.folder=f", "time.steps=20"});
        if (quantity == "profiles")
            more.insert(more.end(), {"output.measurements.profile_columns=2",
                                     "output.measurements.profile_rows=2"});
        return read_scene(good, "s.toml", more).warnings;
    };
    const std::string every = "output.measurements.every_steps=",
                      from = "output.measurements.from_step=",
                      samples = "output.measurements.profile_samples=";
    struct Case {
        std::string quantity;
        Texts wrong;
        std::string proposal;
        Texts right;
    };
    const std::vector<Case> cases = {
        {"profiles", {}, "profile_samples = 3 or less", {samples + "3"}},
        {"profiles", {every + "1000"}, "every_steps = 2 or less", {every + "2"}},
        {"profiles",
         {every + "1000", from + "15"},
         "profile_samples = 6 or less with every_steps = 1",
         {every + "1", samples + "6", from + "15"}},
        {"profiles", {from + "20"}, "a smaller output.measurements.from_step", {every + "1"}},
        {"correlations", {every + "21"}, "every_steps = 20 or less", {every + "20"}},
        {"correlations", {from + "20"}, "a smaller output.measurements.from_step", {from + "5"}},
        {"diffusion",
         {from + "20"},
         "a smaller output.measurements.from_step",
         {every + "1", "output.measurements.correlation_steps=20"}}};
    for (const Case& one : cases) {
        INFO(one.quantity << " " << one.proposal);
        const std::vector<std::string> found = warnings(one.quantity, one.wrong);
        REQUIRE(found.size() == 1);
        CHECK(found[0].find("try: ") != std::string::npos);
        CHECK(found[0].ends_with(one.proposal));
        CHECK(warnings(one.quantity, one.right).empty());
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Oscillating walls and growing discs in a scene: values that are read, and errors.
#include "catch.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/compare.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;
using test::has;
using test::problems_of;
using test::problems_with;

namespace {

using Texts = std::vector<std::string>;

const std::string& good = test::good_scene;

} // namespace

TEST_CASE("oscillating walls are read, and refused where they leave no room") {
    const Texts shaken = {"box.bottom.kind=oscillating", "box.bottom.amplitude=2",
                          "box.bottom.period=10"};
    const auto with = [&](Texts more) {
        more.insert(more.begin(), shaken.begin(), shaken.end());
        return more;
    };
    const auto problems = [&](const Texts& more) { return problems_with(with(more)); };
    const SceneParameters scene = read_scene(good, "s.toml", with({"box.bottom.phase=3.5"}));
    CHECK(scene.effects.boundaries[2] == Boundary{BoundaryKind::oscillating, 1, 0, 0, 2, 10, 3.5});
    CHECK(scene.effects.contact.contact_time == 0); // 0, because a length is used instead
    CHECK(problems({}).empty());
    CHECK(has(problems_with({"box.bottom.kind=oscillating"}), "'box.bottom.amplitude' is missing"));
    CHECK(has(problems_with({"box.bottom.kind=oscillating"}), "'box.bottom.period' is missing"));
    CHECK(has(problems_with({"box.top.period=3"}),
              "no meaning without box.top.kind = \"oscillating\""));
    CHECK(has(problems({"box.bottom.period=0"}), "greater than 0, not 0"));
    CHECK(has(problems({"box.bottom.amplitude=-1"}), "at least 0, not -1"));
    CHECK(has(problems({"box.bottom.period=1e-6"}), "at least 6.4e-05 steps"));
    CHECK(has(problems({"box.bottom.amplitude=99"}), "leaves a box of 100 by 1: too small"));
    CHECK(has(problems({"effects.contact.contact_time=2"}),
              "at most 1.25 steps, an eighth of a wall's period, not 2"));
    CHECK(has(problems({"box.bottom.phase=1"}), "the bottom wall begins inside the box"));
    CHECK(problems({"discs.generator=lattice", "box.bottom.phase=-1"}).empty());
    CHECK(has(problems({"time.method=time-stepped"}),
              "cannot have an oscillating wall together with time.method"));
    CHECK(has(problems({"effects.drag.rate=0.01"}),
              "cannot have an oscillating wall together with drag"));
    CHECK(has(problems({"effects.obstacles.discs=[[10, 20, 1]]"}),
              "cannot have obstacles together with walls that move"));
    CHECK(
        has(problems({"box.left.kind=open"}), "cannot have an open side together with walls that"));
    CHECK(has(problems({"box.bottom.kind=periodic"}), "no meaning without box.bottom.kind"));
}

// A listed disc must be inside the wall where it is at the start, not inside its mean position.
TEST_CASE("listed discs begin before oscillating walls") {
    const std::string one = "[box]\nsize = 100\n[discs]\nradius = 1\n[time]\nsteps = 10\n"
                            "[box.bottom]\nkind = 'oscillating'\namplitude = 2\nperiod = 10\n";
    const auto problems = [&](const std::string& phase, const std::string& y) {
        std::string text;
        for (const Problem& problem : problems_of([&] {
                 read_scene(one, "s.toml",
                            {"box.bottom.phase=" + phase, "discs.list=[[50, " + y + ", 0, 0]]"});
             }))
            text += problem.text;
        return text;
    };
    CHECK(problems("0", "1").empty());
    CHECK(has(problems("0", "0.99"), "before oscillating walls where these are at step 0"));
    CHECK(problems("1.5707963267948966", "3").empty());
    CHECK(has(problems("1.5707963267948966", "2.99"), "is not inside the box"));
    CHECK(problems("-1.5707963267948966", "-0.99").empty());
    CHECK(has(problems("-1.5707963267948966", "-1.01"), "is not inside the box"));
}

TEST_CASE("discs that grow need room until the last step") {
    CHECK(read_scene(good, "s.toml", {"effects.growth.rate=0.25"}).effects.growth == 0.25);
    CHECK(read_scene(good, "s.toml", {"effects.growth.rate=0.25"}).last_packing() ==
          Approx(50 * 3.5 * 3.5 * 3.14159265358979 / 1e4));
    CHECK_FALSE(read_scene(good, "s.toml", {"effects.growth.rate=0"}).effects.are_any());
    CHECK(has(problems_with({"effects.growth.rate=-0.1"}), "must be"));
    CHECK(
        has(problems_with({"effects.growth.rate=1"}),
            "after 10 steps discs of radius 11 would cover 1.901 times the box; there is room for "
            "them up to step 6"));
    // Two discs reach half of a periodic box long before they cover it.
    const Texts two{"discs.count=2", "box.left.kind=periodic", "box.right.kind=periodic"};
    const auto two_growing = [&](const char* rate) {
        Texts texts = two;
        texts.emplace_back(rate);
        return problems_with(texts);
    };
    CHECK(two_growing("effects.growth.rate=2.3").empty());
    CHECK(has(two_growing("effects.growth.rate=2.5"), "room for them up to step 9"));
    // Between walls discs have room up to the width, and along the periodic axis up to half the
    // length.
    const auto in_strip = [&](const char* rate) {
        Texts texts = two;
        texts.emplace_back("box.size=[100, 3]");
        texts.emplace_back(rate);
        return problems_with(texts);
    };
    CHECK(in_strip("effects.growth.rate=0.049").empty());
    CHECK(has(in_strip("effects.growth.rate=0.051"), "room for them up to step 9"));
    for (const char* other :
         {"time.method=time-stepped", "effects.contact.kind=none", "effects.gravity.y=-0.01",
          "effects.drag.rate=0.1", "box.top.kind=open"})
        CHECK(has(problems_with({"effects.growth.rate=0.1", other}),
                  "cannot have growing discs together with"));
}

TEST_CASE("a compressed start has a rate of growth, and knows obstacles") {
    const SceneParameters scene = read_scene(
        good, "s.toml", {"discs.generator=compressed", "discs.growth_rate=0.1"});
    CHECK(scene.generator == Generator::compressed);
    CHECK(scene.compression_rate == 0.1);
    CHECK(has(problems_with({"discs.growth_rate=0.1"}),
              "no meaning without discs.generator = \"compressed\""));
    CHECK(has(problems_with({"discs.generator=compressed", "discs.growth_rate=2"}), "from"));
    CHECK(problems_with({"discs.generator=compressed", "effects.obstacles.discs=[[50, 50, 1]]"})
              .empty());
}

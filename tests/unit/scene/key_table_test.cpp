// SPDX-License-Identifier: BSD-3-Clause
// The table of keys: a scene that is written and read back is the same scene, for random scenes
// drawn from the table itself.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "problems_of.hpp"
#include "random_overrides.hpp"
#include "scene/compare.hpp"
#include "scene/disc_columns.hpp"
#include "scene/key.hpp"
#include "scene/key_page.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_text.hpp"

using namespace carrom;
using test::box;
using test::Draw;
using test::is_found_later;
using test::mentions;
using test::places_of;
using test::problems_of;
using test::random_overrides;
using test::Texts;

namespace {

const std::string good = "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = 10\n";

std::vector<Problem> problems_in(const std::string& text, const Texts& overrides = {}) {
    return problems_of([&] { read_scene(text, "s.toml", overrides); });
}

/// Names of all keys that differ between the two scenes.
Texts keys_that_differ(const SceneParameters& a, const SceneParameters& b) {
    Texts names;
    for (const Key& key : keys()) {
        const Table& table = *find_table(key.table());
        if (table.is_in(a) != table.is_in(b))
            names.push_back(table.name);
        else if (table.is_in(a) && !key.is_same(a, b))
            names.push_back(key.name);
    }
    if (a.first_numbers != b.first_numbers) names.push_back("first_numbers");
    if (!(a.effects == b.effects)) names.push_back("effects");
    return names;
}

} // namespace

TEST_CASE("every key says what it takes") {
    std::set<std::string> names;
    for (const Key& key : keys()) {
        CAPTURE(key.name);
        CHECK(names.insert(key.name).second);
        CHECK(find_table(key.table()) != nullptr);
        CHECK((find_table(key.name) != nullptr) == (key.name == "discs.radius"));
        CHECK(!key.help.empty());
        CHECK(key.help.back() == '.');
        CHECK((key.get && key.set));
        const bool has_words = key.kind == Kind::choice || key.kind == Kind::words ||
                               key.kind == Kind::point;
        CHECK(has_words == !key.words.empty());
        const bool has_numbers = key.kind == Kind::number || key.kind == Kind::integer ||
                                 key.kind == Kind::lengths || key.kind == Kind::point ||
                                 key.has_rows();
        CHECK(has_numbers == !key.unit.empty());
        CHECK(key.has_rows() == !key.fields.empty());
        if (key.need) CHECK(!key.need->text.empty());
        for (const std::string_view other : key.instead_of) CHECK(find_key(other) != nullptr);
        for (const std::string_view other : key.or_from) CHECK(find_key(other) != nullptr);
    }
    for (const Rule& rule : rules()) {
        CAPTURE(rule.one);
        CHECK((!rule.keys.empty() || rule.boundary));
        for (const std::string_view key : rule.keys) CHECK(find_key(key) != nullptr);
        CHECK_FALSE(rule.is_broken(SceneParameters{}));
        CHECK(conflicts_page().find(rule.why) != std::string::npos);
    }
}

TEST_CASE("what is written of a scene reads as the same scene, whatever it names") {
    Draw draw(31);
    std::set<std::string> written;
    int n_read = 0;
    const auto is_written = [&written](const Key& key) {
        return key.name == "box.size" || is_found_later(key) || written.count(key.name) == 1;
    };
    const auto keys_not_in = [](const auto& known) {
        std::vector<const Key*> others;
        for (const Key& key : keys())
            if (!known(key)) others.push_back(&key);
        return others;
    };
    // Some keys have a meaning only in few scenes. So further scenes are drawn, each with one of
    // the keys that have not occurred, until all have.
    constexpr int enough = 1500;
    for (int i = 0; i < 300000; ++i) {
        std::vector<const Key*> missing;
        if (n_read > enough) {
            missing = keys_not_in(is_written);
            if (missing.empty()) break;
        }
        const std::size_t turn = static_cast<std::size_t>(i);
        Texts overrides = random_overrides(draw, missing.empty() ? nullptr
                                                                 : missing[turn % missing.size()]);
        // If one key of a scene is wrong, it is left out, because the others may be right.
        std::vector<Problem> problems = problems_in(box, overrides);
        for (int round = 0; round < 8 && !problems.empty(); ++round) {
            for (const Problem& problem : problems)
                std::erase_if(overrides, [&problem](const std::string& text) {
                    return problem.place == "--set " + text.substr(0, text.find('='));
                });
            if (mentions(problems, "is missing")) break;
            problems = problems_in(box, overrides);
        }
        if (!problems.empty()) continue;
        const SceneParameters scene = read_scene(box, "s.toml", overrides);
        // then the lines of a file give the radius and the number of discs
        if (scene.radius == 0) continue;
        const std::string text = scene_text(scene);
        CAPTURE(overrides, text);
        const auto faults = problems_in(text);
        for (const Problem& fault : faults) UNSCOPED_INFO(to_string(fault));
        REQUIRE(faults.empty());
        const SceneParameters again = read_scene(text, "s.toml");
        REQUIRE(keys_that_differ(scene, again) == Texts{});
        REQUIRE(scene_text(again) == text);
        REQUIRE(physical_differences(scene, again).empty());
        n_read += 1;
        for (const std::string& override : overrides)
            written.insert(override.substr(0, override.find('=')));
    }
    CHECK(n_read > enough);
    for (const Key& key : keys()) { // every key has occurred
        CAPTURE(key.name);
        CHECK(is_written(key));
    }
}

TEST_CASE("spins, masses and a column of radii are written as they were read") {
    const std::string rough =
        "[effects.contact]\nkind = \"rough\"\nrestitution = 0.9\ntangential_restitution = 0.5\n";
    for (const char* discs :
         {"[[discs.species]]\ncount = 3\nradius = 2\nspin = -1\n[[discs.species]]\ncount = 40\n"
          "radius = 0.5\nmass = 3\n[[discs.species]]\ncount = 4\nradius = 0.5\nmass = 3\nspin = "
          "2\n",
          "[discs]\nradius = 1\nlist = [[10, 10, 1, 0], [20, 20, 0, 0, 0.25]]\n",
          "[discs]\nlist = [[10, 10, 1, 0, 2, 3, 1.5], [20, 20, -0.0, 0, 1, 1]]\n"}) {
        const SceneParameters scene = read_scene(box + discs + rough, "s.toml");
        CHECK(keys_that_differ(scene, read_scene(scene_text(scene), "s.toml")) == Texts{});
    }
    const std::string columns =
        box + "[discs]\ncount = 2\nfile = \"d\"\ncolumns = [\"radius\", \"mass\", \"spin\"]\n" +
        rough;
    std::istringstream lines("0 10 10 0 0 1 2 3\n1 20 20 0 0 4 5 6\n");
    const DiscColumns read = read_disc_columns(
        lines, read_scene(SceneText{"s.toml", columns, 0, false, {}}));
    const SceneParameters scene = read_scene(SceneText{"s.toml", columns, 0, false, read});
    const SceneParameters again = read_scene(
        SceneText{"s.toml", scene_text(scene), 0, false, read});
    CHECK(keys_that_differ(scene, again) == Texts{});
    CHECK(again.disc_columns.size() == 3);
}

TEST_CASE("keys and words of older versions name the new ones") {
    CHECK(mentions(problems_in(good + "collisions = \"one\"\n"),
                   "'time.collisions' is now 'time.method'; write time.method = \"time-stepped\" "
                   "for \"one\""));
    CHECK(mentions(problems_in(good, {"time.collisions=all"}),
                   "write time.method = \"event-driven\" for \"all\""));
    CHECK(mentions(problems_in(good + "method = \"all\"\n"),
                   "'time.method': \"all\" is now \"event-driven\""));
    CHECK(mentions(problems_in(good, {"discs.generator=ancestor"}),
                   "'discs.generator': \"ancestor\" is now \"legacy\""));
    const auto classes = problems_in("[box]\nsize = 10\n[time]\nsteps = 1\n[[discs.classes]]\n"
                                     "count = 3\nradius = 1\n");
    CHECK(mentions(classes, "'discs.classes' is now 'discs.species'"));
}

TEST_CASE("misspelt effects and outputs name the right ones") {
    const std::vector<std::pair<std::string, std::string>> pairs = {
        {"effects.gravty.y=1", "effects.gravity.y"},
        {"effects.contact.restituton=1", "effects.contact.restitution"},
        {"effects.obstacle.discs=[]", "effects.obstacles.discs"},
        {"output.chekpoint.keep=3", "output.checkpoint.keep"},
        {"box.lft.kind=wall", "box.left.kind"}};
    for (const auto& [wrong, right] : pairs) {
        CAPTURE(wrong);
        CHECK(mentions(problems_in(good, {wrong}), "did you mean '" + right + "'?"));
    }
    CHECK(mentions(problems_in(good + "[effects.gravty]\ny = 1\n"),
                   "did you mean 'effects.gravity'?"));
}

TEST_CASE("text that would overrun the parser, and floods of problems, end in few lines") {
    std::string deep = "a";
    for (int i = 0; i < 40000; ++i) deep += ".a";
    for (const std::string& text : {deep + " = 1", '[' + deep + ']', "[[" + deep + "]]",
                                    "x = {" + deep + " = 1}", "'a'." + deep + " = 1"}) {
        const auto problems = problems_in(good + text + '\n');
        CHECK(places_of(problems) == Texts{"s.toml:8"});
        CHECK(mentions(problems, "a key of more than 32 parts"));
    }
    CHECK(problems_in(good, {"discs.list={" + deep + "=1}"}).size() == 1);
    CHECK(problems_in(good + "[output]\nfolder = \"" + deep + "\" # " + deep + '\n').empty());
    CHECK(problems_in(good + "[output]\nfolder = \"\"\"\n" + deep + "\"\"\"\n").empty());

    std::string flood;
    for (int i = 0; i < 100000; ++i) flood += "k" + std::to_string(i) + " = 1\n";
    const auto unknown = problems_in(flood + good);
    CHECK(unknown.size() == 21);
    CHECK(mentions(unknown, "and 99980 more unknown keys"));
    std::string rows = "[box]\nsize = 9\n[time]\nsteps = 1\n[discs]\nradius = 0.01\nlist = [\n";
    for (int i = 0; i < 5000; ++i) rows += "[1, 2],\n";
    CHECK(problems_in(rows + "]\n").size() == 21);
}

TEST_CASE("a name of a file has no NUL, and a speed can be followed") {
    CHECK(
        mentions(problems_in(good + "[output]\nfolder = \"a\\u0000b\"\n"), "has a NUL character"));
    CHECK(mentions(problems_in(good, {"discs.speed=1e60", "time.method=event-driven"}),
                   "crosses the box more than 2^40 times in a micro-step"));
    CHECK(problems_in(good, {"discs.speed=1e60", "time.method=time-stepped"}).empty());
    CHECK(problems_in(good, {"discs.speed=1e12", "time.method=event-driven"}).empty());
    CHECK(mentions(problems_in(good, {"discs.count=1", "time.method=event-driven",
                                      "discs.list=[[5, 5, 1e60, 0]]"}),
                   "crosses the box"));
    CHECK(mentions(problems_in(good, {"box.top.kind=thermal", "box.top.temperature=1e40",
                                      "time.method=event-driven"}),
                   "crosses the box"));
}

// SPDX-License-Identifier: BSD-3-Clause
// The table of keys: every key says what it takes, and what is written of a scene reads as the same
// scene, over scenes drawn at random from the table itself.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/compare.hpp"
#include "scene/disc_columns.hpp"
#include "scene/key.hpp"
#include "scene/key_page.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_text.hpp"

using namespace carrom;
using test::mentions;
using test::places_of;
using test::problems_of;

namespace {

using Texts = std::vector<std::string>;

const std::string good = "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = 10\n";

std::vector<Problem> problems_in(const std::string& text, const Texts& overrides = {}) {
    return problems_of([&] { read_scene(text, "s.toml", overrides); });
}

/// Names of all keys that are not the same in both scenes.
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

class Draw {
public:
    explicit Draw(std::uint64_t seed) : engine_(seed) {}

    std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }
    double share() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

    std::string value(const Key& key) {
        switch (key.kind) {
        case Kind::number: return std::to_string(number(key));
        case Kind::integer: return std::to_string(integer(key));
        case Kind::flag: return below(2) == 0 ? "true" : "false";
        case Kind::text: return "\"a \\\"b\\\" \\\\ c\\t" + std::to_string(below(9)) + "\"";
        case Kind::choice: return '"' + std::string(key.words[below(key.words.size())]) + '"';
        case Kind::words: return words(key);
        case Kind::point:
            return below(2) == 0 ? "\"centre\"" : "[-3.5, " + std::to_string(share()) + ']';
        default: return "";
        }
    }
    std::string rows(const std::string& name) {
        std::string list;
        for (std::size_t i = 0, n = 1 + below(3); i < n; ++i) {
            const std::string x = std::to_string(10 + 80 * share()),
                              y = std::to_string(10 + 80 * share());
            if (name == "discs.region") return "[1, 2, " + x + ", " + y + ']';
            if (name == "effects.field.strengths") return "[0.5]";
            list += name == "discs.streams"
                        ? "{region = [1, 2, " + x + ", " + y + "], velocity = [-0.0, " + y + "]}, "
                    : name == "discs.species"
                        ? "{count = 2, radius = " + std::to_string(0.5 + share()) +
                              ", mass = " + x + spin() + region(x, y) + "}, "
                    : name == "discs.groups"
                        ? "{count = 3, temperature = " + std::to_string(share()) + region(x, y) +
                              (below(2) == 0 ? ", generator = \"compressed\"" : "") +
                              (below(4) == 0 ? ", freeze = true" : "") + "}, "
                    : name == "discs.list" ? '[' + x + ", " + y + ", -0.0, 1e-7], "
                    : name.ends_with("segments") || name == "discs.freeze"
                        ? "[1, 2, " + x + ", " + y + "], "
                    : name.ends_with("polygons") ? "[1, 2, " + x + ", " + y + ", 1, " + y + "], "
                                                 : '[' + x + ", " + y + ", 3], ";
        }
        return '[' + list + ']';
    }

private:
    double number(const Key& key) {
        const double low = std::isfinite(key.range.low) ? std::max(key.range.low, 1e-3) : -1;
        const double high = std::min(key.range.high, 1.0);
        return low + (high - low) * share();
    }
    std::int64_t integer(const Key& key) {
        const auto low = static_cast<std::int64_t>(std::max(key.range.low, 0.0));
        return low + static_cast<std::int64_t>(below(key.range.high < 10 ? 9 : 40));
    }
    std::string words(const Key& key) {
        std::string list;
        for (const std::string_view word : key.words)
            if (below(2) == 0) list += '"' + std::string(word) + "\", ";
        return '[' + list + ']';
    }
    std::string region(const std::string& x, const std::string& y) {
        return below(4) == 0 ? ", region = [0, 0, " + x + ", " + y + "]" : "";
    }
    std::string spin() { return below(2) == 0 ? ", spin = " + std::to_string(share()) : ""; }

    std::mt19937_64 engine_;
};

/// A scene is whole once the file is read, or discs that freeze are found.
bool is_found_later(const Key& key) {
    return key.name.starts_with("discs.from") || key.name == "discs.frozen";
}

const std::string box = "[box]\nsize = 100\n[time]\nsteps = 10\n";

/// Fields, and discs that exchange sizes: keys that go with each other, in some scenes.
void add_fields(Draw& draw, Texts& texts) {
    if (draw.below(8) == 0)
        texts.insert(texts.end(), {"effects.gravity.amplitude_y=0.01", "effects.gravity.period=50",
                                   "time.sync_every=1"});
    if (draw.below(8) == 0)
        texts.insert(texts.end(), {"effects.field.kind=trap", "effects.field.stiffness_y=0.01",
                                   "time.sync_every=1"});
    if (draw.below(8) == 0)
        texts.insert(texts.end(), {"effects.field.kind=sine", "effects.field.amplitude=0.01",
                                   "time.sync_every=1"});
    if (draw.below(8) == 0)
        texts.insert(texts.end(),
                     {"discs.species=[{count = 2, radius = 1}, {count = 3, radius = 0.5}]",
                      "effects.swap.rounds=2"});
}

const std::string two_species =
    "discs.species=[{count = 2, radius = 1}, {count = 3, radius = 0.5}]";

/// Inlets, and what needs several species, in some scenes.
void add_mixtures(Draw& draw, Texts& texts) {
    if (draw.below(8) == 0) {
        const std::string side = std::string("box.") + boundary_names[draw.below(4)];
        texts.insert(texts.end(), {side + ".kind=open", side + ".inlet.rate=0.1",
                                   side + ".inlet.temperature=0.01"});
    }
    if (draw.below(8) == 0)
        texts.insert(texts.end(),
                     {two_species, "effects.contact.kind=restitution",
                      "effects.contact.restitution=0.9",
                      "effects.contact.pairs=[{species = [1, 2], restitution = 0.5}]"});
    if (draw.below(8) == 0)
        texts.insert(texts.end(),
                     {two_species, "output.folder=a", "output.measurements.every_steps=1",
                      "output.measurements.quantities=[\"profiles\"]",
                      "output.measurements.profile_species=1"});
}

/// A short scene that has a key which few of the others may have; empty for other keys.
Texts scene_with(Draw& draw, const Key& key) {
    if (key.name.starts_with("time.") && !key.has_rows()) // without effects
        return {"discs.count=20", "discs.radius=1",
                draw.below(2) == 0 ? "time.arithmetic=naive" : "time.method=time-stepped",
                key.name + '=' + draw.value(key)};
    const std::string end = ".inlet.species";
    if (!key.name.ends_with(end)) return {};
    const std::string side = key.name.substr(0, key.name.size() - end.size());
    return {two_species, side + ".kind=open", side + ".inlet.rate=0.1",
            side + ".inlet.temperature=0.01", key.name + "=1"};
}

/// Discs in one of the ways there are, features that need several keys, and about one other key in
/// eight; most are right or nearly so.
Texts random_overrides(Draw& draw, const Key* wanted = nullptr) {
    if (Texts texts = wanted ? scene_with(draw, *wanted) : Texts(); !texts.empty()) return texts;
    Texts texts = {"time.method=event-driven"};
    const std::string source[] = {"discs.list", "discs.species", "discs.groups"};
    if (const std::size_t way = draw.below(6); way < 3)
        texts.push_back(source[way] + '=' + draw.rows(source[way]));
    if (texts.back().starts_with(source[2]))
        texts.push_back("discs.radius=1");
    else if (texts.size() == 1)
        texts.insert(texts.end(), {"discs.count=20", "discs.radius=1"});
    if (draw.below(3) == 0)
        texts.insert(texts.end(), {"effects.contact.kind=rough", "effects.contact.restitution=0.9",
                                   "effects.contact.tangential_restitution=0.5"});
    const auto any_side = [&draw] { return std::string("box.") + boundary_names[draw.below(4)]; };
    if (draw.below(4) == 0) {
        const std::string side = any_side();
        texts.insert(texts.end(), {side + ".kind=thermal", side + ".temperature=0.1"});
    }
    if (draw.below(3) == 0) {
        const std::string side = any_side();
        texts.insert(texts.end(),
                     {side + ".kind=oscillating", side + ".amplitude=0.5", side + ".period=3"});
        if (draw.below(2) == 0) texts.push_back(side + ".phase=3.5");
    }
    if (draw.below(12) == 0)
        texts.insert(texts.end(), {"box.top.kind=moving", "box.top.speed=0.01"});
    if (draw.below(4) == 0)
        texts.insert(texts.end(),
                     {"effects.thermostat.kind=langevin", "effects.thermostat.rate=0.01",
                      "effects.thermostat.temperature=0.01"});
    if (texts.back().ends_with("temperature=0.01") && draw.below(2) == 0)
        texts.push_back(draw.below(2) == 0 ? "effects.activity.speed=0.01"
                                           : "effects.activity.force=0.01");
    if (draw.below(8) == 0)
        texts.insert(texts.end(),
                     {"effects.gravity.y=-0.01", "effects.contact.kind=restitution",
                      "effects.contact.restitution=0.9", "effects.lasting_contacts.speed=0.05"});
    add_fields(draw, texts);
    add_mixtures(draw, texts);
    if (draw.below(4) == 0) texts.push_back("time.arithmetic=naive");
    if (draw.below(8) == 0) // with keys that need these quantities, and periodic sides
        texts.insert(texts.end(), {"box.left.kind=periodic", "box.right.kind=periodic",
                                   "box.bottom.kind=periodic", "box.top.kind=periodic",
                                   "output.folder=a", "output.measurements.every_steps=1",
                                   "output.measurements.quantities=[\"structure_factor\", "
                                   "\"diffusion\", \"correlations\"]",
                                   "output.measurements.correlation_points=8"});
    if (draw.below(8) == 0) // without quantities that few scenes may have
        texts.insert(texts.end(), {"output.folder=a", "output.measurements.every_steps=1",
                                   "output.measurements.quantities=[\"profiles\"]"});
    if (draw.below(8) == 0) // both sides, and the flow goes through the others
        texts.insert(texts.end(),
                     {"box.left.kind=periodic", "box.right.kind=periodic",
                      "box.bottom.kind=sheared", "box.top.kind=sheared", "effects.shear.rate=0.1"});
    for (const Key& key : keys()) {
        if (key.name == "box.size" || (&key != wanted && draw.below(8) != 0)) continue;
        if (std::ranges::find(source, key.name) != std::end(source)) continue;
        if (is_found_later(key)) continue;
        texts.push_back(key.name + '=' + (key.has_rows() ? draw.rows(key.name) : draw.value(key)));
    }
    return texts;
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
    // Some keys have a meaning in few scenes, so there are more scenes until each has been there.
    // Each of these scenes asks for one of the keys that are missing.
    std::vector<const Key*> missing;
    constexpr int enough = 1500;
    for (int i = 0; i < 30000 || (i < 300000 && (!missing.empty() || n_read <= enough)); ++i) {
        if (i + 1 >= 30000) missing = keys_not_in(is_written);
        const std::size_t turn = static_cast<std::size_t>(i);
        Texts overrides = random_overrides(draw, missing.empty() ? nullptr
                                                                 : missing[turn % missing.size()]);
        // One wrong key in a scene is left out; the rest may be right.
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
        if (scene.radius == 0) continue; // the lines of a file give it, with the number of discs
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
    for (const Key& key : keys()) { // each has been there
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

// SPDX-License-Identifier: BSD-3-Clause
// Words of other programs for sides, contacts and thermostats are errors that name the right word.
// Tables on the command line have the same meaning as in scenes, and a temperature that a flow does
// not keep is a warning.
#include <string>
#include <utility>

#include "catch.hpp"

#include "problems_of.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;
using test::mentions;
using test::problems_of;

TEST_CASE("words of other programs are errors that name what there is") {
    const std::string scene = "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = "
                              "10\n";
    for (const auto& [setting, advice] : {
             std::pair{"effects.thermostat.kind=nose-hoover", "try: \"langevin\" or \"andersen\""},
             {"effects.thermostat.kind=gaussian", "try: \"rescale\""},
             {"effects.thermostat.kind=Nose-Hoover", "try: \"langevin\" or \"andersen\""},
             {"effects.thermostat.kind=v_rescale", "try: \"rescale\""},
             {"discs.radius.distribution=Gaussian", "try: \"normal\""},
             {"discs.radius.distribution=bidisperse", "try: discs.species"},
             {"effects.contact.kind=inelastic", "try: \"restitution\""},
             {"effects.contact.kind=granular", "try: \"restitution\" or \"rough\""},
             {"effects.contact.kind=hertz", "discs are hard, and contacts take no time"},
             {"box.top.kind=lees-edwards", "try: \"sheared\", at bottom and top"},
             {"box.left.kind=reflecting", "try: \"wall\""},
             {"discs.polydispersity=0.2", "try: discs.radius.distribution"},
         }) {
        INFO(setting);
        const std::string text = setting;
        CHECK(mentions(problems_of([&] { read_scene(scene, "s.toml", {text}); }), advice));
    }
}

TEST_CASE("a wrong word has no other errors that only follow from it") {
    const std::string scene = "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = "
                              "10\n";
    for (const auto& [setting, number] : {
             std::pair{"effects.contact={kind = \"inelastic\", contact_time = 0.01}",
                       "effects.contact.kind"},
             {"box.left={tangential_restitution = 2, velocity = 0.1}",
              "box.left.tangential_restitution"},
             {"box={bottom = {kind = \"sheared\"}, top = {kind = \"lees-edwards\"}, "
              "left = {kind = \"periodic\"}, right = {kind = \"periodic\"}}",
              "box.top.kind"},
         }) {
        INFO(setting);
        const std::string text = setting;
        const auto found = problems_of([&] { read_scene(scene, "s.toml", {text}); });
        CHECK(found.size() == 1);
        CHECK(mentions(found, number));
    }
}

TEST_CASE("a word of the command line drops what the scene's other word needed") {
    const std::string scene =
        "[box]\nsize = 100\nbottom = {kind = \"thermal\", temperature = 1, velocity = 0.1}\n"
        "[discs]\ncount = 50\nradius = 1\n[time]\nsteps = 10\n"
        "[effects]\ncontact = {kind = \"restitution\", restitution = 0.9, contact_time = 0.01}\n"
        "thermostat = {kind = \"kicks\", strength = 0.1, seed = 5}\n";
    const Thermostat other =
        read_scene(scene, "s.toml",
                   {"effects.thermostat={kind = \"langevin\", rate = 0.01, temperature = 1}"})
            .effects.thermostat;
    CHECK(other.kind == ThermostatKind::langevin);
    CHECK(other.seed == 5); // the key has a meaning for this kind, so it stays
    const Effects plain = read_scene(scene, "s.toml",
                                     {"box.bottom.kind=wall", "effects.contact.kind=elastic",
                                      "effects.thermostat.kind=none"})
                              .effects;
    CHECK(plain.boundaries[2].kind == BoundaryKind::wall);
    CHECK(!plain.are_any());
    // Keys that have no meaning in the scene itself are still errors, and so are keys on the
    // command line.
    std::string wrong = scene;
    wrong.replace(wrong.find("seed = 5"), 8, "rate = 5");
    CHECK(mentions(
        problems_of([&] { read_scene(wrong, "s.toml", {"effects.thermostat.kind=none"}); }),
        "'effects.thermostat.rate' has no meaning"));
    CHECK(mentions(problems_of([&] {
                       read_scene(scene, "s.toml",
                                  {"box.bottom.kind=wall", "box.bottom.temperature=2"});
                   }),
                   "'box.bottom.temperature' has no meaning"));
}

TEST_CASE("a table on the command line is that of a scene") {
    const std::string scene = "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = "
                              "10\n";
    const auto sizes =
        read_scene(scene, "s.toml",
                   {"discs.radius={distribution = \"lognormal\", mean = 2, polydispersity = 0.2}"})
            .sizes;
    REQUIRE(sizes);
    CHECK(sizes->kind == SizeKind::lognormal);
    CHECK(sizes->mean == 2);
    CHECK(sizes->polydispersity == 0.2);
    const SceneParameters equal = read_scene(
        "[box]\nsize = 100\n[discs]\ncount = 50\n[discs.radius]\n"
        "distribution = \"normal\"\nmean = 1\n[time]\nsteps = 10\n",
        "s.toml", {"discs.radius=2"});
    CHECK(!equal.sizes);
    CHECK(equal.radius == 2);
    const SceneParameters thermal = read_scene(
        scene, "s.toml", {"box={left = {kind = \"thermal\", temperature = 0.5}}"});
    CHECK(thermal.effects.boundaries[0].temperature == 0.5);
    for (const auto& [setting, advice] : {
             std::pair{"discs.radius={distribution=lognormal}", "quote it for the shell"},
             {"discs.radius={distribution = \"lognormal\"", "quote it for the shell"},
             {"discs.radius={spread = 0.2}", "no such key 'discs.radius.spread'"},
             {"discs.radius={distribution = 3}", "must be \"uniform\""},
         }) {
        INFO(setting);
        const std::string text = setting;
        CHECK(mentions(problems_of([&] { read_scene(scene, "s.toml", {text}); }), advice));
    }
}

TEST_CASE("a flow that does not keep its temperature has a warning") {
    std::string scene = "[box]\nsize = 100\n";
    for (const std::string side : {"left", "right"}) scene += side + ".kind = \"periodic\"\n";
    for (const std::string side : {"bottom", "top"}) scene += side + ".kind = \"sheared\"\n";
    scene += "[discs]\ncount = 50\nradius = 1\n[time]\nsteps = 100\n[effects.shear]\nrate = 0.1\n";
    const auto warnings = [&scene](std::vector<std::string> overrides) {
        std::string all;
        for (const std::string& text : read_scene(scene, "s.toml", overrides).warnings)
            all += text + '\n';
        return all;
    };
    CHECK(warnings({"discs.speed=0.1"}).empty());
    const std::string start = "discs.temperature=0.01", rescale = "effects.thermostat.kind=rescale";
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    CHECK(has(warnings({start}), "heats discs that lose no energy for ever"));
    CHECK(has(
        warnings({start, "effects.contact.kind=restitution", "effects.contact.restitution=0.8"}),
        "collisions lose what it gives"));
    CHECK(has(warnings({start, rescale, "effects.thermostat.temperature=0.02"}),
              "the thermostat keeps its own"));
    CHECK(warnings({start, rescale, "effects.thermostat.temperature=0.01"}).empty());
    // 50 discs of radius 1 in a box of 100 collide 0.035 sqrt(kT) times in a step.
    CHECK(warnings({rescale, "effects.thermostat.temperature=3"}).empty());
    CHECK(
        has(warnings({rescale, "effects.thermostat.temperature=4"}), "collides 4.5 times or more"));
    CHECK(has(warnings({rescale, "effects.thermostat.temperature=4", "time.steps=10"}),
              "never acts: it would every 64 steps"));
}

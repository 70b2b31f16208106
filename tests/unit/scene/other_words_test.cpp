// SPDX-License-Identifier: BSD-3-Clause
// Words that other programs have for sides, contacts and thermostats are errors that name what
// there is instead.
#include <string>
#include <utility>

#include "catch.hpp"

#include "problems_of.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;
using test::mentions;
using test::problems_of;

TEST_CASE("Words of other programs are errors that name what there is") {
    const std::string scene = "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = "
                              "10\n";
    for (const auto& [setting, advice] : {
             std::pair{"effects.thermostat.kind=nose-hoover", "try: \"langevin\" or \"andersen\""},
             {"effects.thermostat.kind=gaussian", "try: \"rescale\""},
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

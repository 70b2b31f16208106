// SPDX-License-Identifier: BSD-3-Clause
// Walls and obstacles that rub, in a scene: values that are read, and error messages.
#include "catch.hpp"

#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/effects/effect.hpp"
#include "scene/read_scene.hpp"

using namespace carrom;
using test::mentions;

namespace {

const std::string rubbing_scene =
    "[box]\nsize = 100\n[discs]\ncount = 50\nradius = 1\n[time]\nsteps = 10\n";

std::vector<Problem> rubbing_problems(const std::vector<std::string>& overrides) {
    return test::problems_of([&] { read_scene(rubbing_scene, "s.toml", overrides); });
}

} // namespace

TEST_CASE("walls that rub and slide are read, and keys without a meaning named") {
    const SceneParameters scene = read_scene(
        rubbing_scene, "s.toml",
        {"box.top.tangential_restitution=0.5", "box.top.friction=0.2", "box.top.velocity=0.1",
         "box.left.kind=thermal", "box.left.temperature=2", "box.left.velocity=-0.3",
         "effects.obstacles.discs=[[10, 20, 3]]", "effects.obstacles.tangential_restitution=1"});
    CHECK(scene.effects.boundaries[3].surface == Surface{0.5, 0.2, 0.1});
    CHECK(scene.effects.boundaries[0].surface.velocity == -0.3);
    CHECK(scene.effects.fixed_bodies.surface.rubs());
    CHECK(
        summary_of(scene.effects).find("top wall rubs with 0.5, friction 0.2 and slides at 0.1") !=
        std::string::npos);
    CHECK(read_scene(rubbing_scene, "s.toml", {"box.top.tangential_restitution=0.5"})
              .effects.are_any());
    CHECK(mentions(
        rubbing_problems({"box.top.velocity=0.1"}),
        "no meaning without box.top.kind = \"thermal\" or a tangential_restitution above -1"));
    CHECK(mentions(rubbing_problems({"box.top.friction=0.1"}),
                   "no meaning without box.top.tangential_restitution above -1"));
    CHECK(mentions(rubbing_problems({"box.top.kind=open", "box.top.tangential_restitution=0"}),
                   "no meaning without box.top.kind = \"wall\", \"moving\" or \"oscillating\""));
    CHECK(mentions(rubbing_problems({"box.top.tangential_restitution=1.5"}),
                   "from -1 to 1, not 1.5"));
    CHECK(mentions(
        rubbing_problems({"effects.obstacles.tangential_restitution=0"}),
        "no meaning without 'effects.obstacles.discs', 'segments', 'arcs', 'polygons' or a "
        "'box.shape'"));
    CHECK(mentions(rubbing_problems({"box.top.tangential_restitution=0.5",
                                     "effects.growth.rate=0.01", "time.method=event-driven"}),
                   "cannot have growing discs together with sides that are no"));
}

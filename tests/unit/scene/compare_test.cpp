// SPDX-License-Identifier: BSD-3-Clause
// A restart may change how long a run is and what it writes, but no setting that affects the bits.
#include "scene/compare.hpp"

#include "catch.hpp"

#include "scene/read_scene.hpp"

using namespace carrom;

namespace {

constexpr const char* base =
    "[box]\nsize = 100\n[discs]\ncount = 10\nradius = 1\n[time]\nsteps = 5\n";

std::vector<std::string> differences(const std::vector<std::string>& overrides) {
    return physical_differences(read_scene(base, "s.toml"),
                                read_scene(base, "other.toml", overrides));
}

} // namespace

TEST_CASE("what has no say in the bits is no difference") {
    CHECK(differences({}).empty());
    CHECK(differences({"time.steps=9", "output.text=ends", "output.folder=a",
                       "output.trajectory.every_steps=2"})
              .empty());
    CHECK(differences({"discs.radius=1.0", "discs.seed=3210", "discs.generator=random",
                       "time.sync_every=64"})
              .empty());
}

TEST_CASE("everything else is, and is named") {
    for (const char* override :
         {"box.size=101", "discs.count=11", "discs.radius=1.5", "discs.generator=lattice",
          "discs.speed=2", "discs.velocities=uniform", "discs.seed=1", "time.method=time-stepped",
          "time.micro_steps=2", "time.sync_every=63", "time.precision=single",
          "time.arithmetic=naive", "discs.packing=0.01"}) {
        const std::string key = std::string(override).substr(0, std::string(override).find('='));
        const auto found = differences({override});
        CAPTURE(override);
        REQUIRE(found.size() == 1);
        CHECK(found[0].find(key == "discs.packing" ? "discs.radius" : key) != std::string::npos);
    }
    const std::string listed =
        "[box]\nsize = 9\n[discs]\nradius = 1\nlist = [[2, 2, 0, 1]]\n[time]\nsteps = 5\n";
    const SceneParameters there = read_scene(listed, "s.toml"),
                          here = read_scene(listed, "s.toml", {"discs.list=[[2, 2, 0, 2]]"});
    CHECK(physical_differences(there, there).empty());
    CHECK(physical_differences(there, here) ==
          std::vector<std::string>{"'discs.list' is another list there"});
}

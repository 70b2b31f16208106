// SPDX-License-Identifier: BSD-3-Clause
// Counts of species from shares, groups in the order of ids, and scenes without their frozen discs.
#include "catch.hpp"

#include <string>
#include <vector>

#include "problems_of.hpp"
#include "scene/compare.hpp"
#include "scene/frozen_discs.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene_text.hpp"

using namespace carrom;
using test::mentions;
using test::problems_of;

namespace {

const std::string box = "[box]\nsize = 100\n[time]\nsteps = 10\n[discs]\n";

SceneParameters scene_of(const std::string& discs) { return read_scene(box + discs, "s.toml"); }

std::vector<std::uint64_t> counts_of(const SceneParameters& scene) {
    std::vector<std::uint64_t> counts;
    for (const Species& one : scene.effects.species) counts.push_back(one.count);
    return counts;
}

using Counts = std::vector<std::uint64_t>;

} // namespace

TEST_CASE("shares give whole numbers of the right sum, to the largest rest") {
    const auto shares = [](const std::string& count, const std::string& a, const std::string& b,
                           const std::string& c) {
        return counts_of(scene_of(count + "\nspecies = [{share = " + a +
                                  ", radius = 1}, {share = " + b + ", radius = 2}, {share = " + c +
                                  ", radius = 3}]"));
    };
    // two shares of 2.5: the first one is rounded up
    CHECK(shares("count = 10", "0.5", "0.25", "0.25") == Counts{5, 3, 2});
    CHECK(shares("count = 10", "0.52", "0.24", "0.24") == Counts{5, 3, 2}); // 5.2, 2.4, 2.4
    CHECK(shares("count = 7", "0.2", "0.2", "0.6") == Counts{2, 1, 4});     // 1.4, 1.4, 4.2
    CHECK(shares("count = 101", "0.1", "0.1", "0.8") == Counts{10, 10, 81});
    // A mean square radius of 0.5 + 0.25 * 4 + 0.25 * 9 = 3.75: 0.3 * 1e4 / (3.75 pi) = 254.6
    CHECK(shares("packing = 0.3", "0.5", "0.25", "0.25") == Counts{127, 64, 64});
}

TEST_CASE("groups count by species, then in their order, and are written as they were read") {
    const SceneParameters scene = scene_of(
        "species = [{radius = 1}, {radius = 2, mass = 3}]\n"
        "[[discs.groups]]\ncount = 3\nspecies = 2\ntemperature = 0\n"
        "[[discs.groups]]\ncount = 5\nregion = [0, 0, 50, 50]\ngenerator = \"lattice\"\n"
        "[[discs.groups]]\npacking = 0.02\nspecies = 2\nspeed = 0.5\nfreeze = true\n");
    REQUIRE(scene.groups.size() == 3);
    CHECK(scene.groups[0].count == 5);
    CHECK(scene.groups[0].region == StartRegion{0, 0, 50, 50});
    CHECK(scene.groups[0].generator == Generator::lattice);
    CHECK(scene.groups[1].temperature == 0.0);
    CHECK(scene.groups[2].count == 16); // 0.02 * 1e4 / (4 pi) = 15.9
    CHECK((scene.groups[2].speed == 0.5 && scene.groups[2].is_frozen));
    CHECK(counts_of(scene) == Counts{5, 19});
    CHECK(scene.n_discs == 24);
    CHECK(scene.awaits_frozen());
    const SceneParameters again = read_scene(scene_text(scene), "s.toml");
    CHECK(again.groups == scene.groups);
    CHECK(again.regions == scene.regions);
    CHECK(physical_differences(scene, again).empty());
}

TEST_CASE("a scene without its frozen discs is the one that its settings say") {
    for (const char* discs :
         {"radius = 1\ncount = 40\nfreeze = [[0, 0, 50, 50]]\n",
          "species = [{count = 4, radius = 2}, {count = 16, radius = 1, region = [0, 0, 50, 50]}, "
          "{count = 20, radius = 1}]\nfreeze = [[0, 0, 50, 50]]\n",
          "species = [{radius = 2}, {radius = 1}]\n[[discs.groups]]\ncount = 4\nfreeze = true\n"
          "[[discs.groups]]\ncount = 36\nspecies = 2\n"}) {
        CAPTURE(discs);
        SceneParameters scene = scene_of(discs);
        std::vector<FrozenDisc> frozen;
        for (const double id : {0.0, 1.0, 2.0, 3.0, 10.0, 39.0})
            frozen.push_back({id, 0.1 * id, 1.0 / 3 + id, 1});
        set_frozen(scene, frozen);
        CHECK(scene.n_discs == 34);
        CHECK(scene.radius == 1);
        CHECK(scene.effects.fixed_bodies.discs.size() == 6);
        CHECK_FALSE(scene.awaits_frozen());
        std::uint64_t n = 0;
        for (const std::uint64_t count : counts_of(scene)) n += count;
        CHECK((n == 0 || n == 34));
        const SceneParameters again = read_scene(box + discs, "s.toml", scene.overrides);
        CHECK(again.effects == scene.effects);
        CHECK(again.frozen == frozen);
        CHECK(again.groups == scene.groups);
        CHECK(again.regions == scene.regions);
        CHECK(physical_differences(scene, again).empty());
    }
    const auto problems = problems_of([] {
        read_scene(box + "radius = 1\ncount = 2\nfreeze = [[0, 0, 9, 9]]\n", "s.toml",
                   {"discs.frozen=[[0, 1, 1, 1], [1, 5, 5, 1]]"});
    });
    CHECK(mentions(problems, "all 2 discs are frozen"));
}

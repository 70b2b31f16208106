// SPDX-License-Identifier: BSD-3-Clause
// The shared scenes are valid, all different, have collisions, and lose none of their known
// contacts.
#include "catch.hpp"

#include <cmath>
#include <set>

#include "scenes.hpp"
#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::test;

TEST_CASE("scenes have distinct names and legal discs") {
    std::set<std::string> names;
    std::vector<TestScene> scenes = small_scenes();
    CHECK(scenes.size() > 300);
    for (const TestScene& scene : large_scenes()) scenes.push_back(scene);
    for (const TestScene& scene : scenes) {
        INFO(scene.name);
        CHECK(names.insert(scene.name).second);
        CHECK(scene.steps > 0);
        std::set<DiscId> ids;
        bool all_inside = true;
        for (const InputDisc& disc : scene.discs) {
            ids.insert(disc.id);
            const double low = scene.setting.radius,
                         high = scene.setting.box_size - scene.setting.radius;
            all_inside = all_inside && disc.x >= low && disc.x <= high && disc.y >= low &&
                         disc.y <= high;
        }
        CHECK(all_inside);
        CHECK(ids.size() == scene.discs.size());
        CHECK(*ids.rbegin() == scene.discs.size() - 1);
    }
}

TEST_CASE("no contact on a boundary in time is lost") {
    for (const TestScene& scene : boundary_contacts()) {
        INFO(scene.name);
        reference::TimeSteppedReference run(scene.setting, scene.discs);
        run.run_steps(scene.steps);
        CHECK(run.counters().pair_collisions == *scene.expected_pair_collisions);
    }
}

TEST_CASE("the small scenes meet all that the rule has to decide") {
    reference::Counters sum;
    std::size_t corners = 0, stops = 0, at_end = 0, ties = 0;
    for (const TestScene& scene : small_scenes()) {
        INFO(scene.name);
        reference::TimeSteppedReference run(scene.setting, scene.discs);
        for (std::int64_t n = 0; n < scene.steps * scene.setting.micro_steps; ++n) {
            const std::vector<DiscState> before(run.discs().begin(), run.discs().end());
            run.run_micro_steps(1);
            for (const DiscState& disc : run.discs()) {
                const DiscState& old = before[disc.id];
                stops += run.clock() > 0 && disc.tau == run.clock();
                corners += disc.wall_collisions > old.wall_collisions && disc.vx * old.vx < 0 &&
                           disc.vy * old.vy < 0;
            }
        }
        for (const DiscState& disc : run.discs()) {
            CHECK(std::isfinite(disc.x + disc.y + disc.vx + disc.vy));
        }
        const reference::Counters& counters = run.counters();
        CHECK(counters.candidates == counters.rejected_candidates + run.log().size());
        sum.candidates += counters.candidates;
        sum.rejected_candidates += counters.rejected_candidates;
        sum.wall_collisions += counters.wall_collisions;
        sum.pair_collisions += counters.pair_collisions;
        for (std::size_t i = 0; i < run.log().size(); ++i) {
            at_end += run.log()[i].t == 1;
            ties += i > 0 && run.log()[i].t == run.log()[i - 1].t && run.log()[i].t > 0;
        }
    }
    CAPTURE(sum.candidates, sum.rejected_candidates, sum.wall_collisions, sum.pair_collisions,
            corners, stops, at_end, ties);
    CHECK(sum.rejected_candidates > 1000);
    CHECK(sum.wall_collisions > 10000);
    CHECK(sum.pair_collisions > 10000);
    CHECK(corners > 100);
    CHECK(stops > 1000);
    CHECK(at_end > 100);
    CHECK(ties > 1000);
}

TEST_CASE("a transposed scene gives transposed bits, a scaled one scaled bits") {
    std::vector<TestScene> scenes;
    for (const auto family :
         {gases, fast_scenes, chains, breaks, wall_scenes, boundary_contacts, overlaps}) {
        for (const TestScene& scene : family()) {
            if (scene.discs.size() <= 60) scenes.push_back(scene);
        }
    }
    for (const TestScene& scene : scenes) {
        INFO(scene.name);
        reference::TimeSteppedReference plain(scene.setting, scene.discs);
        plain.run_steps(scene.steps);
        const TestScene across = transposed(scene), larger = scaled(scene, 180),
                        smaller = scaled(scene, -180);
        reference::TimeSteppedReference turned(across.setting, across.discs);
        reference::TimeSteppedReference grown(larger.setting, larger.discs),
            shrunk(smaller.setting, smaller.discs);
        for (reference::TimeSteppedReference* run : {&turned, &grown, &shrunk})
            run->run_steps(scene.steps);
        CHECK(turned.log() == plain.log());
        CHECK(grown.log() == plain.log());
        CHECK(shrunk.log() == plain.log());
        std::size_t differences = 0;
        for (std::size_t i = 0; i < scene.discs.size(); ++i) {
            const DiscState &a = plain.discs()[i], &b = turned.discs()[i], &c = grown.discs()[i],
                            &d = shrunk.discs()[i];
            differences += !(a.x == b.y && a.y == b.x && a.vx == b.vy && a.vy == b.vx &&
                             a.tau == b.tau);
            differences += !(std::ldexp(a.x, 180) == c.x && std::ldexp(a.vy, 180) == c.vy &&
                             a.tau == c.tau);
            differences += !(std::ldexp(a.x, -180) == d.x && std::ldexp(a.vy, -180) == d.vy &&
                             a.tau == d.tau);
        }
        CHECK(differences == 0);
    }
}

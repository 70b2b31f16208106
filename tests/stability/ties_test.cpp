// SPDX-License-Identifier: BSD-3-Clause
// Family 3, ties: several collisions of one disc at exactly the same time.
//
// Why hard: mechanics does not define the result of a three-body collision, so the order decides.
// An order that depends on memory, threads or arrival gives other results on other machines, and
// comparing times with a tolerance is not transitive. Sources: the DynamO and SMASH trackers
// (coincident particles loop for ever); Rapier's and Unity's notes on sorting. Bounds: the bits of
// the references for every order in memory, window and machine shape; momentum is passed on exactly
// if the numbers are exact; a run that cannot end reports so.
#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/state_hash.hpp"
#include "event_driven.hpp"
#include "hold.hpp"
#include "runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};

/// The reference's hash, computed on every rank.
StateHash reference_hash(const TestScene& scene, Method method) {
    if (method == Method::time_stepped) {
        reference::TimeSteppedReference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        return hash_of(reference.discs());
    }
    reference::EventDrivenReference reference(scene.setting, scene.discs, 100000);
    reference.run_steps(scene.steps);
    return hash_of(reference.discs());
}

/// Counts runs that differ from the reference, for several orders in memory and windows.
double count_differences(const TestScene& scene, Method method) {
    const StateHash expected = reference_hash(scene, method);
    double n_different = 0;
    unsigned seed = 0;
    for (const std::optional<double> window :
         {std::optional<double>(), std::optional<double>(0.3), std::optional<double>(1.0)}) {
        Tuning tuning;
        tuning.window = window;
        tuning.rebalance_above = seed % 2 == 0 ? 0 : 1.05;
        INFO(scene.name << ", rule " << name_of(method));
        const bool is_same = run(scene, method, tuning, ++seed).totals.hash == expected;
        CHECK(is_same);
        n_different += !is_same;
    }
    return n_different;
}

/// `n` discs around one at rest that all reach it at the same time.
TestScene symmetric_hit(const std::vector<std::pair<double, double>>& directions) {
    TestScene scene = empty_scene(
        std::to_string(directions.size()) + " discs hit one at the same time", 32, 0.5, 20);
    add_disc(scene, 16, 16);
    for (const auto& [ex, ey] : directions) add_disc(scene, 16 + 5 * ex, 16 + 5 * ey, -ex, -ey);
    return scene;
}

std::vector<TestScene> symmetric_hits() {
    const double h = std::sqrt(0.75);
    std::vector<TestScene> scenes = {
        symmetric_hit({{1, 0}, {-1, 0}}), symmetric_hit({{1, 0}, {-1, 0}, {0, 1}, {0, -1}}),
        symmetric_hit({{1, 0}, {-0.5, h}, {-0.5, -h}}),
        symmetric_hit({{0.6, 0.8}, {-0.6, 0.8}, {0.6, -0.8}, {-0.6, -0.8}})};
    TestScene four = empty_scene("four discs meet in a square", 16, 0.5, 20);
    for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) add_disc(four, 8 + 4 * x, 8 + 4 * y, -x, -y);
    }
    scenes.push_back(four);
    return scenes;
}

/// A wall and a pair at one time, and pairs whose discs are both at walls.
std::vector<TestScene> walls_and_pairs() {
    TestScene at_once = empty_scene("a disc meets a wall and another disc at once", 8, 0.5, 12);
    add_disc(at_once, 1.5, 4, -1, 0);
    add_disc(at_once, 3.5, 4, -2, 0); // touches the first disc when that is at the wall
    TestScene at_walls = empty_scene("both discs of a pair at walls", 3, 0.5, 12);
    add_disc(at_walls, 0.5, 1.5, -0.25, 0.0625);
    add_disc(at_walls, 2.5, 1.5, 0.25, -0.0625);
    TestScene corner = empty_scene("pair and corner at once", 8, 0.5, 12);
    add_disc(corner, 1.5, 1.5, -1, -1);
    add_disc(corner, 2.5, 1.5, -2, -1);
    return {at_once, at_walls, corner};
}

TestScene touching_lattice() {
    TestScene scene = lattice(8, 1);
    scene.name = "all-touching lattice, one kicked";
    scene.setting.box_size += 8;
    for (InputDisc& disc : scene.discs) {
        disc.x += 4;
        disc.y += 4;
    }
    scene.discs[0].vx = 0.75;
    scene.discs[0].vy = 0.5;
    scene.steps = 8;
    return scene;
}

void check_family(const char* what, const std::vector<TestScene>& scenes, bool is_for_all = true) {
    for (const Method method : both) {
        if (method == Method::event_driven && !is_for_all) continue;
        double n_different = 0;
        std::uint64_t seed = 300;
        for (const TestScene& scene : scenes) {
            n_different += count_differences(scene, method);
            n_different += count_differences(shuffled(transposed(scene), ++seed), method);
        }
        hold("ties", std::string(what) + ": runs with other bits than the reference",
             name_of(method), n_different, 0);
    }
}

} // namespace

TEST_CASE("ties: symmetric hits of three to five discs", "[ties]") {
    check_family("symmetric hits of 3 to 5 discs", symmetric_hits());
}

TEST_CASE("ties: wall and pair at one time, pairs at walls", "[ties]") {
    check_family("wall and pair at one time", walls_and_pairs());
}

TEST_CASE("ties: the break of a triangle of touching discs", "[ties]") {
    std::vector<TestScene> scenes = {break_shot(5, 0.5, 11, 0), break_shot(5, 0.3, 1.7, 0.3),
                                     break_shot(10, 0.5, 3, 0)};
    for (TestScene& scene : scenes) scene.steps = 25;
    check_family("triangular break", scenes);
}

TEST_CASE("ties: a lattice in which all discs touch", "[ties]") {
    check_family("all-touching lattice", {touching_lattice()});
}

TEST_CASE("ties: Newton's cradle, with gaps and touching", "[ties]") {
    std::vector<TestScene> scenes = {cradle(7, 0.5, 0.125, 0.25), cradle(20, 0.5, 1, 5),
                                     cradle(15, 0.3, 0.07, 0.9)};
    check_family("cradle with gaps", scenes);
    // Discs that touch from wall to wall. With one collision per disc and step the result is a
    // wave; with every collision at its time there is no end.
    check_family("cradle touching from wall to wall", {cradle(9, 0.5, 0, 0.25)}, false);
    const bool is_reported =
        failure_of(cradle(9, 0.5, 0, 1), Method::event_driven).find("collides without end") !=
        std::string::npos;
    hold("ties", "cradle touching from wall to wall: runs that do not end with a message",
         "event-driven", !is_reported, 0);
}

TEST_CASE("ties: a touching cradle in the open hands on its speed exactly", "[ties]") {
    for (const Method method : both) {
        TestScene scene = empty_scene("open cradle", 64, 0.5, 24);
        add_disc(scene, 4, 32, 1, 0);
        for (int i = 0; i < 12; ++i) add_disc(scene, 8 + i, 32);
        const Outcome outcome = run(scene, method);
        double wrong = 0;
        for (const DiscState& disc : outcome.discs)
            wrong = std::max(wrong,
                             std::fabs(disc.vx - (disc.id == 12 ? 1 : 0)) + std::fabs(disc.vy));
        hold("ties", "open touching cradle of 12: largest error of a velocity", name_of(method),
             wrong, 0);
    }
}

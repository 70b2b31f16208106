// SPDX-License-Identifier: BSD-3-Clause
// Family 4, corners and walls: two walls at one time, walls that are touched but not approached,
// boxes without room.
//
// Why hard: a tolerance at walls that is a length (1e-8 in the course program) lets discs bounce
// twice or leave; a corner is two collisions at one time; a disc that fills its box collides
// without end. Source: the tracker threads on lost particles at walls, DynamO's two-wall events.
// Bounds: a disc that hits a corner comes back exactly reversed; no disc is farther outside than 4
// ulp(L) plus its flight in the rounding error of a time, |v| ulp(64).
#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "hold.hpp"
#include "runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};

double largest_speed(const TestScene& scene) {
    double square = 0;
    for (const InputDisc& disc : scene.discs) square += disc.vx * disc.vx + disc.vy * disc.vy;
    return std::sqrt(square);
}

/// The largest distance of a disc outside of the box at any step, divided by the allowed one.
double outside_over_allowed(const TestScene& scene, Method method) {
    const double allowed = 4 * ulp_of(scene.setting.box_size) + largest_speed(scene) * ulp_of(32);
    DiscSystem system = start(scene, method);
    double worst = 0;
    while (system.step() < scene.steps) {
        run_to(system, system.step() + 1);
        worst = std::max(worst, farthest_outside(outcome_of(system), scene.setting) / allowed);
    }
    return worst;
}

} // namespace

TEST_CASE("walls: a shot into a corner at 45 degrees comes back exactly reversed", "[walls]") {
    for (const Method method : both) {
        double n_wrong = 0, n_counted = 0;
        for (const double speed : {0.125, 0.5, 1.0, 3.0}) {
            for (const double sx : {-1.0, 1.0}) {
                for (const double sy : {-1.0, 1.0}) {
                    TestScene scene = empty_scene(
                        "corner shot", 8, 0.5,
                        static_cast<std::int64_t>(std::ceil(2.5 / speed)) + 2);
                    add_disc(scene, 4 + 1.0 * sx, 4 + 1.0 * sy, speed * sx, speed * sy);
                    const DiscState disc = run(scene, method).discs.front();
                    n_wrong += disc.vx != -speed * sx || disc.vy != -speed * sy ||
                               disc.x != disc.y * sx * sy + (sx * sy < 0 ? 8 : 0);
                    n_counted = std::max(n_counted, static_cast<double>(disc.wall_collisions));
                }
            }
        }
        hold("walls", "45 degree corner shots: not exactly reversed, of 16", name_of(method),
             n_wrong, 0);
        hold("walls", "45 degree corner shots: most wall collisions", name_of(method), n_counted,
             method == Method::time_stepped ? 1 : 2);
    }
}

TEST_CASE("walls: leaving one wall while entering the next", "[walls]") {
    for (const Method method : both) {
        double n_wrong = 0;
        for (const double place : {1.0, 3.5, 7.0}) {
            // A disc on the low x wall that moves away from it, towards the high y wall; then one
            // that moves towards the low x wall along y = L - r.
            TestScene scene = empty_scene("leaving one wall for the next", 8, 0.5, 6);
            add_disc(scene, 0.5, place, 0.25, 0.5);
            DiscState disc = run(scene, method).discs.front();
            const bool reaches = place + 0.5 * 6 > 7.5;
            n_wrong += disc.vx != 0.25 || disc.vy != (reaches ? -0.5 : 0.5) ||
                       disc.wall_collisions != (reaches ? 1u : 0u);
            scene.discs[0] = {0, place, 7.5, -0.5, -0.25};
            disc = run(scene, method).discs.front();
            const bool reaches_low = place - 0.5 * 6 <= 0.5; // a contact exactly at the end counts
            n_wrong += disc.vx != (reaches_low ? 0.5 : -0.5) || disc.vy != -0.25 ||
                       disc.wall_collisions != (reaches_low ? 1u : 0u);
        }
        hold("walls", "leaving one wall while entering the next: wrong, of 6", name_of(method),
             n_wrong, 0);
    }
}

TEST_CASE("walls: sliding along a wall and resting on it is no collision", "[walls]") {
    for (const Method method : both) {
        TestScene scene = empty_scene("sliding and resting", 32.7, 0.7, 40);
        const double low = 0.7, high = scene.setting.box_size - scene.setting.radius;
        add_disc(scene, 5, low, 0.3, 0);
        add_disc(scene, 5, high, 0.3, 0);
        add_disc(scene, low, 9, 0, 0.2);
        add_disc(scene, high, 9, 0, 0.2);
        add_disc(scene, low, low);
        add_disc(scene, high, high);
        add_disc(scene, low, high);
        add_disc(scene, 9, low, 0, -0.0);
        scene.discs[7].x = 30;
        scene.discs[7].vy = 0;
        const Outcome outcome = run(scene, method);
        hold("walls", "sliding along walls and resting on them: wall collisions", name_of(method),
             static_cast<double>(outcome.totals.wall_collisions), 0);
        hold("walls", "sliding and resting: distance from the wall", name_of(method),
             std::fabs(outcome.discs[0].y - low) + std::fabs(outcome.discs[3].x - high) +
                 std::fabs(outcome.discs[5].y - high),
             0);
    }
}

TEST_CASE("walls: a disc that fills the box", "[walls]") {
    for (const double speed : {0.0, 1e-9, 0.3, 50.0}) {
        TestScene scene = empty_scene("a disc that fills the box", 2, 1, 20);
        add_disc(scene, 1, 1, speed, -0.75 * speed);
        const Outcome outcome = run(scene, Method::time_stepped);
        hold("walls", "a disc that fills the box, speed " + number(speed) + ": way from its place",
             "time-stepped",
             std::fabs(outcome.discs[0].x_at(outcome.clock) - 1) +
                 std::fabs(outcome.discs[0].y_at(outcome.clock) - 1),
             0);
        const std::string text = failure_of(scene, Method::event_driven);
        const bool is_reported = speed == 0
                                     ? text.empty()
                                     : text.find("collides without end") != std::string::npos;
        hold("walls",
             "a disc that fills the box, speed " + number(speed) +
                 ": runs that do not end with a message",
             "event-driven", !is_reported, 0);
    }
}

TEST_CASE("walls: no disc is outside by more than the method allows", "[walls]") {
    for (const Method method : both) {
        double worst = 0;
        for (const TestScene& scene : wall_scenes()) {
            if (method == Method::event_driven && scene.cascades_when_event_driven) continue;
            // Boxes with hardly any room: a billion bounces a step in the event-driven method.
            if (method == Method::event_driven &&
                scene.setting.box_size < 2.1 * scene.setting.radius)
                continue;
            INFO(scene.name);
            const double outside = outside_over_allowed(scene, method);
            CHECK(outside <= 1);
            worst = std::max(worst, outside);
        }
        hold("walls",
             "corner shots, tight boxes, discs at walls: farthest outside, over 4 ulp(L) + |v| "
             "ulp(64)",
             name_of(method), worst, 1);
    }
}

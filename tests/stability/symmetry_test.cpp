// SPDX-License-Identifier: BSD-3-Clause
// Family 6, symmetry: x and y are equivalent, so are left and right if numbers are exact, and time
// can be reversed.
//
// Why hard: a contracted a*b + c*d rounds its two products differently, and some orders put x
// first; a transposed scene shows both at once. Hard discs multiply an error by e every few tenths
// of a mean free time. Sources: reports on fma and exact bits in the project's notes on
// contraction; Dellago, Posch, Hoover, PRE 53, 1485 (1996) for the exponents. Here measured values
// are used: lambda = 1.447 (packing 0.1) and 2.870 (0.3) for sigma = kT = m = 1.
#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "approach.hpp"
#include "dynamics/pair_contact.hpp"
#include "hold.hpp"
#include "runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};

/// Scenes that both methods finish within a second or so.
std::vector<TestScene> scenes_for(Method method) {
    std::vector<TestScene> chosen;
    std::size_t number = 0;
    const std::size_t nth = Communicator::world().size() == 1
                                ? 1
                                : 5; // on several ranks, starting and messages take long
    for (TestScene scene : small_scenes()) {
        if (++number % nth != 0) continue;
        const bool is_fast = std::any_of(
            scene.discs.begin(), scene.discs.end(), [&](const InputDisc& disc) {
                return std::fabs(disc.vx) + std::fabs(disc.vy) > 8 * scene.setting.radius;
            });
        if (method == Method::event_driven && (scene.cascades_when_event_driven || is_fast))
            continue;
        if (scene.discs.size() > 100) continue;
        scene.steps = std::min<std::int64_t>(scene.steps, 12);
        chosen.push_back(scene);
    }
    return chosen;
}

/// The scene reflected at x = L/2, with the same ids.
TestScene mirrored(TestScene scene) {
    for (InputDisc& disc : scene.discs) {
        disc.x = scene.setting.box_size - disc.x;
        disc.vx = -disc.vx;
    }
    return scene;
}

bool refuses(const TestScene& scene, Method method) {
    return method == Method::event_driven &&
           failure_of(scene, method).find("overlap") != std::string::npos;
}

/// The scene at `outcome` with all velocities reversed.
TestScene reversed(TestScene scene, const Outcome& outcome) {
    for (InputDisc& disc : scene.discs) {
        const DiscState& state = outcome.discs[disc.id];
        disc = {disc.id, state.x_at(outcome.clock), state.y_at(outcome.clock), -state.vx,
                -state.vy};
    }
    return scene;
}

} // namespace

TEST_CASE("symmetry: transposed scenes have transposed bits", "[symmetry]") {
    for (const Method method : both) {
        double n_different = 0, n_scenes = 0;
        for (const TestScene& scene : scenes_for(method)) {
            if (refuses(scene, method)) continue;
            INFO(scene.name << ", rule " << name_of(method));
            const Outcome a = run(scene, method), b = run(transposed(scene), method);
            const bool is_same = std::equal(a.discs.begin(), a.discs.end(), b.discs.begin(),
                                            [](const DiscState& p, const DiscState& q) {
                                                return p.x == q.y && p.y == q.x && p.vx == q.vy &&
                                                       p.vy == q.vx && p.tau == q.tau &&
                                                       p.pair_collisions == q.pair_collisions &&
                                                       p.wall_collisions == q.wall_collisions;
                                            });
            CHECK(is_same);
            n_different += !is_same;
            n_scenes += 1;
        }
        hold("symmetry", number(n_scenes) + " scenes: without bitwise transposed results",
             name_of(method), n_different, 0);
    }
}

TEST_CASE("symmetry: the predicate has mirrored bits", "[symmetry]") {
    Approaches some(601);
    double n_different = 0;
    for (int i = 0; i < 300000; ++i) {
        const Approach c = some.any();
        const auto delay = [&](double sx, double sy, bool is_transposed) {
            return is_transposed ? contact_delay(sy * c.dy, sx * c.dx, sy * c.wy, sx * c.wx,
                                                 c.sigma, 1e-12 * c.sigma)
                                 : contact_delay(sx * c.dx, sy * c.dy, sx * c.wx, sy * c.wy,
                                                 c.sigma, 1e-12 * c.sigma);
        };
        const double plain = delay(1, 1, false);
        for (int image = 1; image < 8; ++image)
            n_different += delay(image & 1 ? -1 : 1, image & 2 ? -1 : 1, (image & 4) != 0) != plain;
    }
    hold("symmetry", "predicate: mirror images and rotations with other bits, of 2.1e6", "both",
         n_different, 0);
}

TEST_CASE("symmetry: scenes of exact numbers have mirrored bits", "[symmetry]") {
    for (const Method method : both) {
        double n_different = 0, n_scenes = 0;
        for (const TestScene& scene : scenes_for(method)) {
            if (!scene.is_exact) continue;
            INFO(scene.name << ", rule " << name_of(method));
            const Outcome a = run(scene, method), b = run(mirrored(scene), method);
            const double size = scene.setting.box_size;
            const bool is_same = std::equal(a.discs.begin(), a.discs.end(), b.discs.begin(),
                                            [&](const DiscState& p, const DiscState& q) {
                                                return p.x == size - q.x && p.y == q.y &&
                                                       p.vx == -q.vx && p.vy == q.vy &&
                                                       p.tau == q.tau &&
                                                       p.pair_collisions == q.pair_collisions &&
                                                       p.wall_collisions == q.wall_collisions;
                                            });
            CHECK(is_same);
            n_different += !is_same;
            n_scenes += 1;
        }
        CHECK(n_scenes > 2);
        hold("symmetry",
             number(n_scenes) + " scenes of exact numbers: without bitwise mirrored results",
             name_of(method), n_different, 0);
    }
}

TEST_CASE("symmetry: time reversed, the event-driven method returns to its start", "[symmetry]") {
    struct Gas {
        double packing, lambda, longest;
    };
    for (const Gas& kind : {Gas{0.1, 1.447, 8}, Gas{0.3, 2.870, 4}}) {
        double worst = 0;
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            TestScene scene = gas(64, kind.packing, 0.01, 610 + seed);
            double square = 0;
            for (const InputDisc& disc : scene.discs)
                square += disc.vx * disc.vx + disc.vy * disc.vy;
            const double sigma = 2,
                         thermal_speed = std::sqrt(square / 128); // kT = 1 in each direction
            for (const double share : {0.25, 0.5, 1.0}) {
                scene.steps = std::lround(share * kind.longest * sigma / thermal_speed);
                const Outcome there = run(scene, Method::event_driven);
                const Outcome back = run(reversed(scene, there), Method::event_driven);
                double error = 0;
                for (const InputDisc& disc : scene.discs) {
                    const DiscState& state = back.discs[disc.id];
                    error = std::max({error, std::fabs(state.x_at(back.clock) - disc.x),
                                      std::fabs(state.y_at(back.clock) - disc.y)});
                }
                const double eps = 16 * ulp_of(scene.setting.box_size);
                worst = std::max(worst,
                                 error / (eps * std::exp(2 * kind.lambda * share * kind.longest)));
            }
        }
        hold("symmetry",
             "time reversed, packing " + number(kind.packing) +
                 ": way from the start over 16 ulp(L) exp(2 lambda t)",
             "event-driven", worst, 1);
    }
}

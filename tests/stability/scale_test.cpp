// SPDX-License-Identifier: BSD-3-Clause
// Family 5, scale: results do not depend on the unit of length, and small discs in a wide box lose
// only the digits that doubles lose.
//
// Why hard: any fixed length in the code (a tolerance at walls, a unit of the search) breaks
// scaling; products of four lengths overflow or vanish; far from the origin a coordinate has fewer
// digits. Sources: the toccata proof of the discriminant (its bounds on overflow), Bannerman et al.
// 2014. Bounds: a scene times 2^k has results that are scaled bit by bit, or is an error with a
// reason. A cluster at (L, L) has the same times as one at the origin to 4 ulp if its positions are
// exact, and to 16 ulp(L)/|w| per collision after that.
#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "hold.hpp"
#include "runs.hpp"
#include "scene/read_scene.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Method both[] = {Method::time_stepped, Method::event_driven};

std::vector<TestScene> ordinary_scenes() {
    TestScene tied = lattice(5, 1.25);
    for (InputDisc& disc : tied.discs) disc.vx = disc.id % 2 == 0 ? 0.25 : -0.25;
    tied.steps = 12;
    std::vector<TestScene> scenes = {gas(36, 0.3, 0.5, 501), gas(25, 0.6, 0.3, 502),
                                     break_shot(4, 0.5, 3, 0.1), tied};
    for (TestScene& scene : scenes) scene.steps = std::min<std::int64_t>(scene.steps, 25);
    return scenes;
}

bool is_scaled(const Outcome& small, const Outcome& plain, int exponent) {
    const auto same = [exponent](double scaled, double value) {
        return scaled == std::ldexp(value, exponent);
    };
    return std::equal(small.discs.begin(), small.discs.end(), plain.discs.begin(),
                      [&](const DiscState& a, const DiscState& b) {
                          return same(a.x, b.x) && same(a.y, b.y) && same(a.vx, b.vx) &&
                                 same(a.vy, b.vy) && a.tau == b.tau &&
                                 a.pair_collisions == b.pair_collisions &&
                                 a.wall_collisions == b.wall_collisions;
                      });
}

/// The texts of the problems of a scene of one disc, or of its warnings.
std::string reader_says(double box_size, double radius, const std::string& method,
                        double speed = 0.25) {
    char text[400];
    std::snprintf(text, sizeof text,
                  "[box]\nsize = %.17g\n[discs]\nradius = %.17g\nlist = [[%.17g, %.17g, %.17g, "
                  "0.0]]\n[time]\nsteps = 5\n"
                  "method = \"%s\"\n",
                  box_size, radius, box_size / 2, box_size / 2, speed, method.c_str());
    std::string said;
    try {
        for (const std::string& warning : read_scene(text, "scene.toml").warnings)
            said += "warning: " + warning;
    } catch (const InputError& error) {
        for (const Problem& problem : error.problems()) said += "refused: " + problem.text;
    }
    return said;
}

bool refuses(const std::string& said) {
    return said.find("refused: ") != std::string::npos && said.size() > 30;
}

/// A line of discs along the diagonal, from `x` on in the direction of `sign`; the first disc hits
/// the others. All positions and speeds are multiples of 2^-12.
TestScene cluster(double box_size, double x, double sign, double gap_unit) {
    TestScene scene = empty_scene("cluster at " + number(x), box_size, 0.5, 40);
    const double gaps[] = {1, 0.375, 0.8125, 0.0625, 1.5};
    double place = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        add_disc(scene, x + sign * place, x + sign * 0.25 * static_cast<double>(i % 2),
                 i == 0 ? 0.5 * sign : 0, 0);
        if (i < 5) place += 1 + gap_unit * gaps[i];
    }
    return scene;
}

} // namespace

TEST_CASE("scale: scenes times 2^k have bitwise scaled results", "[scale]") {
    for (const Method method : both) {
        double n_different = 0, n_runs = 0, n_refused = 0;
        for (const TestScene& scene : ordinary_scenes()) {
            const Outcome plain = run(scene, method);
            CHECK(plain.totals.pair_collisions > 3);
            // Every exponent on one rank. On several ranks, where starting takes long, only those
            // near the limits.
            const int stride = Communicator::world().size() == 1 ? 1 : 5;
            for (int k = -250; k <= 250; k += k < -225 || k > 238 ? 1 : stride) {
                const TestScene same = scaled(scene, k);
                const std::string said = reader_says(same.setting.box_size, same.setting.radius,
                                                     name_of(method));
                n_refused += refuses(said);
                if (refuses(said)) continue;
                INFO(scene.name << ", k = " << k);
                const bool is_same = is_scaled(run(same, method), plain, k);
                CHECK(is_same);
                n_different += !is_same;
                n_runs += 1;
            }
        }
        CHECK(n_runs > 150);
        hold("scale",
             number(n_runs) + " scenes times 2^k, k = -250 to 250 (" + number(n_refused) +
                 " more refused): without bitwise scaled results",
             name_of(method), n_different, 0);
    }
}

TEST_CASE("scale: what has no place in the range of doubles is refused with a reason", "[scale]") {
    double n_accepted = 0;
    for (const char* const method : {"time-stepped", "event-driven"}) {
        for (const auto& [box, radius] : {std::pair(0x1p251, 0x1p240),
                                          {0x1p-220, 0x1p-231},
                                          {1e150, 1e-150},
                                          {1e150, 1e145},
                                          {1e-145, 1e-150}}) {
            n_accepted += !refuses(reader_says(box, radius, method));
        }
        n_accepted += !refuses(reader_says(16, 0.5, method, 0x1p251)) +
                      !refuses(reader_says(16, 0.5, method, 0x1p-251));
    }
    n_accepted += !refuses(reader_says(1e7, 1, "time-stepped"));
    CHECK(reader_says(1e7, 1, "event-driven").find("warning: ") == 0);
    hold("scale", "r = 1e-150, L = 1e150, 2^+-251, L/r = 1e7 in the time-stepped method: accepted",
         "both", n_accepted, 0);
}

TEST_CASE("scale: a cluster far from the origin has the times of one near it", "[scale]") {
    for (const Method method : both) {
        const double box_size = method == Method::time_stepped ? 0x1p18
                                                               : 0x1p23; // L/r = 5e5 and 1.7e7
        const auto near = collisions_of(cluster(box_size, 0x1p3, 1, 1), method);
        const auto far = collisions_of(cluster(box_size, box_size - 0x1p3, -1, 1), method);
        REQUIRE(near.size() >= 5);
        REQUIRE(near.size() == far.size());
        const auto time = [](const Collision& c) {
            return static_cast<double>(c.micro_step) + c.time;
        };
        hold("scale", "cluster at (L, L), exact places: error of the first contact, ulp",
             name_of(method), std::fabs(time(near[0]) - time(far[0])) / ulp_of(time(near[0])), 4);
        double worst = 0;
        for (std::size_t i = 0; i < near.size(); ++i) {
            const double bound = 16 * static_cast<double>(i + 1) * ulp_of(box_size / 2) / 0.25;
            worst = std::max(worst, std::fabs(time(near[i]) - time(far[i])) / bound);
        }
        hold("scale",
             "cluster at (L, L), a chain of collisions: error of times over 16 ulp(L)/|w| each",
             name_of(method), worst, 1);
    }
}

// L/r = 1e7 is allowed in the event-driven method, with a warning: then a coordinate has 30 bits
// for a diameter.
TEST_CASE("scale: pairs in a box of 1e7 radii meet when they should", "[scale]") {
    TestScene scene = empty_scene("wide box", 1e7, 1, 400);
    Random random(503);
    std::vector<double> expected;
    for (int i = 0; i < 50; ++i) {
        const auto [ex, ey] = random.direction();
        const double x = random.uniform(1e3, 1e7 - 1e3), y = 1e5 + 1.9e5 * i,
                     gap = random.uniform(1, 100);
        add_disc(scene, x, y, 0.25 * ex, 0.25 * ey);
        add_disc(scene, x + (2 + gap) * ex, y + (2 + gap) * ey, -0.25 * ex, -0.25 * ey);
        expected.push_back(gap / 0.5);
    }
    double worst = 0;
    const std::vector<Collision> found = collisions_of(scene, Method::event_driven);
    REQUIRE(found.size() == expected.size());
    for (const Collision& collision : found) {
        const double time = static_cast<double>(collision.micro_step) + collision.time;
        worst = std::max(worst,
                         std::fabs(time - expected[collision.p / 2]) / (8 * ulp_of(8e6) / 0.5));
    }
    hold("scale", "L/r = 1e7, head-on pairs: error of times over 8 ulp(L)/|w|", "event-driven",
         worst, 1);
}

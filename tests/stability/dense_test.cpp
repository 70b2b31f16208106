// SPDX-License-Identifier: BSD-3-Clause
// Family 7, dense: gaps of a few hundred ulp, ten thousand collisions a disc, in the event-driven
// method.
//
// Why hard: discs fly only 1e-12 diameters between collisions, so the last digits decide about
// every contact, and an overlap is amplified ten thousand times. Sources: Lubachevsky, Stillinger,
// J. Stat. Phys. 60, 561 (1990); Donev, Torquato, Stillinger, J. Comput. Phys. 202, 737 (2005);
// Bannerman et al. 2014. Bounds: no overlap deeper than 64 ulp(L) at any inspection, energy to
// 1e-12, no disc outside by more than 4 ulp(L), and the run ends.
#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "hold.hpp"
#include "runs.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Rows of discs from wall to wall that touch the rows above and below to within `gap`: a jam. The
/// size of the box is computed; within a row discs have the room that the geometry of a square
/// leaves.
TestScene jammed_rows(std::size_t n_rows, std::size_t n_columns, double gap) {
    const double across = 2 * static_cast<double>(n_columns) - 1,
                 up = static_cast<double>(n_rows) - 1;
    const double side = (1 + gap) / std::sqrt(1 / (across * across) + 1 / (up * up));
    TestScene scene = empty_scene("jammed rows", 1 + gap + side, 0.5, 0);
    for (std::size_t row = 0; row < n_rows; ++row) {
        for (std::size_t column = 0; column < n_columns; ++column) {
            add_disc(scene,
                     0.5 + 0.5 * gap + side / across * static_cast<double>(2 * column + row % 2),
                     0.5 + 0.5 * gap + side / up * static_cast<double>(row));
        }
    }
    return scene;
}

/// k x k discs with equal gaps to each other and to the walls.
TestScene jammed_square(std::size_t k, double gap) {
    TestScene scene = empty_scene("jammed square", static_cast<double>(k) * (1 + gap) + gap, 0.5,
                                  0);
    for (std::size_t i = 0; i < k * k; ++i) {
        add_disc(scene, 0.5 + gap + static_cast<double>(i % k) * (1 + gap),
                 0.5 + gap + static_cast<double>(i / k) * (1 + gap));
    }
    return scene;
}

/// A hexagonal cluster with equal gaps between neighbours, in a box with free room around it.
TestScene open_cluster(std::size_t k, double gap) {
    TestScene scene = empty_scene("open cluster", static_cast<double>(k) + 8, 0.5, 0);
    for (std::size_t i = 0; i < k * k; ++i) {
        const double row = static_cast<double>(i / k), column = static_cast<double>(i % k);
        add_disc(scene, 4 + (1 + gap) * (column + 0.5 * (i / k % 2 == 0 ? 0 : 1)),
                 4 + (1 + gap) * std::sqrt(0.75) * row * (1 + 1e-15));
    }
    return scene;
}

/// Runs until discs have had `collisions` on average, and checks the bounds at every inspection.
void cascade(TestScene scene, const std::string& what, double gap, double collisions) {
    Random random(701);
    set_speeds(scene, 32 * gap, random);
    scene.steps = 1 << 30;
    DiscSystem system = start(scene, Method::event_driven);
    const Outcome before = outcome_of(system);
    const double n = static_cast<double>(scene.discs.size()),
                 ulp = ulp_of(scene.setting.box_size / 2);
    double overlap = 0, outside = 0, energy = 0, done = 0;
    for (int sample = 0; sample < 2000 && done < collisions; ++sample) {
        run_to(system, system.step() + (sample < 8 ? 1 : 64));
        const Outcome now = outcome_of(system);
        overlap = std::max(overlap, deepest_overlap(now, 1) / ulp);
        outside = std::max(outside, farthest_outside(now, scene.setting) / ulp);
        energy = std::max(energy, std::fabs(squared_speeds(now) / squared_speeds(before) - 1));
        done = 2 * static_cast<double>(now.totals.pair_collisions) / n;
    }
    INFO(what << ": " << done << " collisions a disc");
    CHECK(done >= collisions);
    hold("dense", what + ": deepest overlap, ulp(L)", "event-driven", overlap, 64);
    hold("dense", what + ": farthest outside, ulp(L)", "event-driven", outside, 4);
    hold("dense", what + ": change of the energy", "event-driven", energy, 1e-12);
}

} // namespace

TEST_CASE("dense: jammed rows, gap 1e-12, 1e4 collisions a disc", "[dense]") {
    cascade(jammed_rows(6, 4, 1e-12),
            "24 discs in jammed rows, gap 1e-12 sigma, 1e4 collisions a disc", 1e-12, 10000);
}

TEST_CASE("dense: a jammed square lattice, gap 1e-12, 1e4 collisions a disc", "[dense]") {
    cascade(jammed_square(8, 1e-12),
            "64 discs in a jammed square lattice, gap 1e-12 sigma, 1e4 collisions a disc", 1e-12,
            10000);
}

TEST_CASE("dense: gaps of an ulp or two of the box", "[dense]") {
    cascade(jammed_square(6, 0x1p-50),
            "36 discs in a jammed square lattice, gap 1 ulp(L), 1e3 collisions a disc", 0x1p-50,
            1000);
}

TEST_CASE("dense: an open hexagonal cluster with gap 1e-12 flies apart", "[dense]") {
    cascade(open_cluster(16, 1e-12), "open hexagonal cluster of 256, gap 1e-12 sigma", 1e-12, 10);
}

TEST_CASE("dense: 120 discs, 1e4 collisions a disc", "[dense][.hours]") {
    cascade(jammed_rows(12, 10, 1e-12),
            "120 discs in jammed rows, gap 1e-12 sigma, 1e4 collisions a disc", 1e-12, 10000);
}

TEST_CASE("dense: 1512 discs at packing 0.89, 1e4 collisions a disc", "[dense][.hours]") {
    cascade(jammed_rows(42, 36, 1e-12),
            "1512 discs at packing 0.89, gap 1e-12 sigma, 1e4 collisions a disc", 1e-12, 10000);
}

// Walls reduce the packing: in a box at least this many discs are needed for 0.9.
TEST_CASE("dense: 10246 discs at packing 0.9, 1e4 collisions a disc", "[dense][.hours]") {
    cascade(jammed_rows(109, 94, 1e-12),
            "10246 discs at packing 0.9, gap 1e-12 sigma, 1e4 collisions a disc", 1e-12, 10000);
}

// SPDX-License-Identifier: BSD-3-Clause
// Two programs for the time-stepped method that share no formula. They agree exactly if numbers are
// exact, and otherwise to within rounding, until trajectories diverge.
#include "catch.hpp"

#include <algorithm>
#include <cmath>

#include "legacy.hpp"
#include "scenes.hpp"
#include "time_stepped.hpp"

using namespace carrom;
using namespace carrom::test;
using reference::LegacyReference;
using reference::TimeSteppedReference;

namespace {

double x_now(const DiscState& disc, double clock) { return disc.x + disc.vx * (clock - disc.tau); }
double y_now(const DiscState& disc, double clock) { return disc.y + disc.vy * (clock - disc.tau); }

/// The largest distance in x or y between the same discs of two runs.
double largest_gap(const std::vector<DiscState>& a, const std::vector<DiscState>& b) {
    double gap = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        gap = std::max({gap, std::fabs(a[i].x - b[i].x), std::fabs(a[i].y - b[i].y)});
    return gap;
}

template <class Run> std::vector<DiscState> where_now(const Run& run, double clock) {
    std::vector<DiscState> discs(run.discs().begin(), run.discs().end());
    for (DiscState& disc : discs) {
        const double x = x_now(disc, clock), y = y_now(disc, clock);
        disc.x = x;
        disc.y = y;
        disc.tau = 0;
    }
    return discs;
}

struct Agreement {
    std::uint64_t collisions = 0; ///< number of collisions until the horizon
    double gap = 0;               ///< largest gap until the horizon, in box sizes
};

/// Runs until discs that were displaced by 1e-12 box sizes at the start differ by 1e-8. Beyond that
/// nothing can be compared.
Agreement compare_until_horizon(const TestScene& scene) {
    TestScene displaced = scene;
    const double size = scene.setting.box_size, radius = scene.setting.radius;
    for (InputDisc& disc : displaced.discs) {
        const double shift = (disc.id % 2 == 0 ? 1e-12 : -1e-12) * size;
        disc.x = std::clamp(disc.x + shift, radius, size - radius);
        disc.y = std::clamp(disc.y - shift, radius, size - radius);
    }
    TimeSteppedReference run(scene.setting, scene.discs), other(scene.setting, displaced.discs);
    LegacyReference legacy(scene.setting, scene.discs);
    Agreement result;
    for (std::int64_t n = 0; n < scene.steps * scene.setting.micro_steps; ++n) {
        run.run_micro_steps(1);
        other.run_micro_steps(1);
        legacy.run_micro_steps(1);
        const std::vector<DiscState> now = where_now(run, run.clock());
        if (largest_gap(now, where_now(other, other.clock())) > 1e-8 * size) break;
        result.gap = std::max(result.gap, largest_gap(now, where_now(legacy, 0)) / size);
        result.collisions = run.log().size();
        if (run.counters() != legacy.counters()) result.gap = 1;
    }
    return result;
}

} // namespace

TEST_CASE("the course program's formulas agree exactly where numbers are exact") {
    std::uint64_t collisions = 0;
    std::size_t scenes = 0;
    for (const TestScene& scene : small_scenes()) {
        if (!scene.is_exact) continue;
        INFO(scene.name);
        TimeSteppedReference run(scene.setting, scene.discs);
        LegacyReference legacy(scene.setting, scene.discs);
        run.run_steps(scene.steps);
        legacy.run_steps(scene.steps);
        CHECK(run.counters() == legacy.counters());
        CHECK(run.log() == legacy.log());
        CHECK(largest_gap(where_now(run, run.clock()), where_now(legacy, 0)) == 0);
        bool same_velocities = true;
        for (std::size_t i = 0; i < run.discs().size(); ++i) {
            const DiscState &a = run.discs()[i], &b = legacy.discs()[i];
            same_velocities = same_velocities && a.vx == b.vx && a.vy == b.vy;
        }
        CHECK(same_velocities);
        collisions += run.log().size();
        scenes += 1;
    }
    CHECK(scenes > 60);
    CHECK(collisions > 5000);
}

TEST_CASE("the course program's formulas agree to rounding until chaos") {
    std::uint64_t collisions = 0;
    for (const auto family : {gases, still_gases, fast_scenes}) {
        for (const TestScene& scene : family()) {
            INFO(scene.name);
            const Agreement agreement = compare_until_horizon(scene);
            CHECK(agreement.gap < 1e-7);
            collisions += agreement.collisions;
        }
    }
    CHECK(collisions > 5000);
}

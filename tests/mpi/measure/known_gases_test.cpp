// SPDX-License-Identifier: BSD-3-Clause
// Measured tables compared with known results for gases.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"
#include "statistics/pair_distances.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// The largest distance between a distribution that was counted in bins and `cumulative`, at the
/// ends of bins.
template <class Cumulative>
double largest_distance(const std::vector<double>& counts, const std::vector<double>& ends,
                        double all, const Cumulative& cumulative) {
    double below = 0, largest = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        below += counts[k];
        largest = std::max(largest, std::fabs(below / all - cumulative(ends[k])));
    }
    return largest;
}

constexpr double kolmogorov_one_in_a_thousand = 1.95;

} // namespace

// Summed over a fine grid of differences. The difference d of two independent points in [0, a] has
// the density (a - |d|) / a^2.
TEST_CASE("measurements: the share of ideal pairs is the integral of their differences' density") {
    const double a = 3, b = 2;
    for (const double r : {0.1, 0.7, 1.5, 2.0}) {
        const int n = 2000;
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            const double x = (i + 0.5) / n * r, height = std::sqrt(r * r - x * x);
            // The integral over y of (b - y) / b^2, times four for the signs of x and y.
            sum += 4 * (a - x) / (a * a) * (b * height - height * height / 2) / (b * b) * r / n;
        }
        CHECK(share_of_ideal_pairs(a, b, r) == Approx(sum).epsilon(1e-4));
    }
}

// Points by rejection; the distance is below r for a share of pairs, with a binomial scatter.
TEST_CASE("measurements: the shares of ideal pairs in round boxes are those of points there") {
    constexpr double length = 3, radius = 2;
    std::mt19937_64 random(20260);
    std::uniform_real_distribution<double> along(-length / 2 - radius, length / 2 + radius),
        across(-radius, radius);
    const auto point = [&](double straight) {
        for (;;) {
            const double x = along(random), y = across(random),
                         beyond = std::max(std::fabs(x) - straight, 0.0);
            if (beyond * beyond + y * y <= radius * radius) return std::array{x, y};
        }
    };
    constexpr int n = 400000;
    for (const double straight : {0.0, length / 2}) {
        std::vector<double> counts(8, 0);
        for (int k = 0; k < n; ++k) {
            const auto p = point(straight), q = point(straight);
            const double bin = std::hypot(p[0] - q[0], p[1] - q[1]) / 0.25;
            if (bin < 8) ++counts[static_cast<std::size_t>(bin)];
        }
        for (std::size_t k = 0; k < counts.size(); ++k) {
            const double inner = 0.25 * static_cast<double>(k), outer = inner + 0.25;
            const double share = straight > 0 ? share_of_ideal_pairs_in_stadium(
                                                    2 * straight, radius, inner, outer)
                                              : share_of_ideal_pairs_in_circle(radius, outer) -
                                                    share_of_ideal_pairs_in_circle(radius, inner);
            CHECK(std::fabs(counts[k] - n * share) < 4.5 * std::sqrt(n * share));
        }
    }
}

TEST_CASE("measurements: a stadium without straight sides is a circle, and all pairs are one") {
    double sum = 0;
    for (double inner = 0; inner < 4; inner += 0.125) {
        const double share = share_of_ideal_pairs_in_stadium(0, 2, inner, inner + 0.125);
        CHECK(share == Approx(share_of_ideal_pairs_in_circle(2, inner + 0.125) -
                              share_of_ideal_pairs_in_circle(2, inner))
                           .epsilon(1e-5));
        sum += share_of_ideal_pairs_in_stadium(2, 1, inner, inner + 0.125);
    }
    CHECK(sum == Approx(1).epsilon(1e-5));
    CHECK(share_of_ideal_pairs_in_circle(2, 4) == 1);
}

TEST_CASE("measurements: discs that do not meet are anywhere: g is 1") {
    const Communicator world = Communicator::world();
    TestScene test = gas(1500, 0.05, 1, 81);
    test.setting.effects.contact.kind = ContactKind::none;
    test.steps = 4000;
    const SceneParameters scene = measured(test, Method::event_driven, 400, 800);
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    advance_to(system, sampler, 4000);
    const std::vector<double> pairs = column_of(sampler.tables(), "radial_distribution", "pairs"),
                              g = column_of(sampler.tables(), "radial_distribution", "g");
    for (std::size_t k = 0; k < g.size(); ++k) {
        INFO("bin " << k << " with " << pairs[k] << " pairs, g = " << g[k]);
        CHECK(std::fabs(g[k] - 1) < 5 / std::sqrt(pairs[k] / g[k]));
    }
}

// The contact value g(sigma) follows from Z - 1 = 2 eta g(sigma). Henderson: g(sigma) = (1 - 7 eta
// / 16) / (1 - eta)^2 (Mol. Phys. 30, 971 (1975)).
TEST_CASE("measurements: a gas has Maxwell's velocities, one pressure on all sides, and g of hard "
          "discs") {
    const Communicator world = Communicator::world();
    const double eta = 0.2;
    TestScene test = gas(1000, eta, 0.2, 82);
    test.steps = 3000;
    SceneParameters scene = measured(test, Method::event_driven, 250, 500);
    scene.measurements->give("bins", 120);
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    advance_to(system, sampler, 3000);
    const std::vector<MeasuredTable> tables = sampler.tables();
    const Totals totals = system.totals();
    const double n_samples = 11, n = 1000, kT = totals.kinetic_energy / n;
    const auto normal = [&](double v) { return 0.5 * std::erfc(-v / std::sqrt(2 * kT)); };
    const auto maxwell = [&](double v) { return 1 - std::exp(-v * v / (2 * kT)); };
    for (const char* component : {"vx_count", "vy_count"})
        CHECK(largest_distance(column_of(tables, "velocities", component),
                               column_of(tables, "velocities", "to"), n_samples * n,
                               normal) < kolmogorov_one_in_a_thousand / std::sqrt(n_samples * n));
    CHECK(largest_distance(column_of(tables, "speeds", "count"), column_of(tables, "speeds", "to"),
                           n_samples * n,
                           maxwell) < kolmogorov_one_in_a_thousand / std::sqrt(n_samples * n));

    // Pressure of the bulk at this packing, and the effect of walls: Z_box = Z_bulk + 0.98 /
    // sqrt(N) (docs/understanding/validation.md).
    const double pressure = n * kT / (scene.box.x * scene.box.x) * (1.57036 + 0.98 / std::sqrt(n));
    for (const char* side : {"left", "right", "bottom", "top"}) {
        const double measured_pressure = column_of(tables, "wall_pressure", side)[0],
                     error = column_of(tables, "wall_pressure", std::string(side) + "_error")[0];
        INFO(side << " " << measured_pressure << " +- " << error << ", " << pressure
                  << " expected");
        CHECK(error < 0.05 * pressure);
        CHECK(measured_pressure == Approx(pressure).margin(4 * error));
    }
    // g is 0 inside a diameter. Just outside it is the contact value, minus the decrease over half
    // a bin.
    const std::vector<double> g = column_of(tables, "radial_distribution", "g");
    for (std::size_t k = 0; k < 40; ++k) CHECK(g[k] == 0);
    const double contact = (1 - 7 * eta / 16) / ((1 - eta) * (1 - eta));
    CHECK(g[40] == Approx(contact).epsilon(0.08));
}

TEST_CASE("measurements: the density over a thermal floor falls as the barometric formula says") {
    const Communicator world = Communicator::world();
    TestScene test = gas(1000, 0.01, 0.2, 83);
    test.setting.effects.contact.kind = ContactKind::none;
    test.setting.effects.boundaries[2] = {BoundaryKind::thermal, 1, 1, 0};
    const double height = 3 / (test.setting.box_size -
                               // the box is three times the height of the gas
                               2 * test.setting.radius);
    test.setting.effects.gravity.y = -height;
    test.setting.sync_every = 16;
    test.steps = 100000;
    SceneParameters scene = measured(test, Method::event_driven, 100000, 6000);
    scene.measurements->give("bins", 200);
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    advance_to(system, sampler, 6000);
    const double low = scene.radius, span = scene.box.x - 2 * scene.radius;
    const auto barometric = [&](double y) {
        const double h = std::clamp(y - low, 0.0, span) * height;
        return (1 - std::exp(-h)) / (1 - std::exp(-3.0));
    };
    CHECK(largest_distance(column_of(sampler.tables(), "density_y", "count"),
                           column_of(sampler.tables(), "density_y", "to"), 1000,
                           barometric) < kolmogorov_one_in_a_thousand / std::sqrt(1000.0));
}

TEST_CASE("measurements: discs that meet nothing are displaced by their velocities") {
    const Communicator world = Communicator::world();
    TestScene test = empty_scene("free discs", 1000, 1, 64);
    Random random(84);
    double squares = 0;
    for (int i = 0; i < 200; ++i) {
        const double vx = random.uniform(-1, 1), vy = random.uniform(-1, 1);
        add_disc(test, 450 + 8 * (i % 14), 450 + 8 * (i / 14), vx, vy);
        squares += vx * vx + vy * vy;
    }
    test.setting.effects.contact.kind = ContactKind::none;
    const SceneParameters scene = measured(test, Method::time_stepped, 8);
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    advance_to(system, sampler, 64);
    const std::vector<double> steps = column_of(sampler.tables(), "displacement", "steps"),
                              sums = column_of(sampler.tables(), "displacement", "sum");
    REQUIRE(steps.size() == 9);
    for (std::size_t k = 0; k < steps.size(); ++k)
        CHECK(sums[k] == Approx(squares / 200 * steps[k] * steps[k]).epsilon(1e-12));
}

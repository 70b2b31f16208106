// SPDX-License-Identifier: BSD-3-Clause
// Displacements and products of velocities in windows, against sums over all discs; diffusion in a
// gas against Enskog's theory.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Boundary seam{BoundaryKind::periodic, 1, 0, 0};

struct Case {
    const char* name;
    Method method;
    Effects effects;
};

std::vector<Case> cases() {
    Effects none, around, falling;
    around.boundaries.fill(seam);
    Effects mixed = around;
    mixed.species = {{100, 1, 1}, {50, 1, 7}};
    falling.boundaries[0] = falling.boundaries[1] = seam;
    falling.gravity = {0, -0.003};
    return {{"walls, time-stepped", Method::time_stepped, none},
            {"all round", Method::event_driven, around},
            {"two masses, all round", Method::event_driven, mixed},
            {"along x, with gravity", Method::event_driven, falling}};
}

/// Samples at 5, 9, 13 ... Windows of three times four steps.
SceneParameters with_diffusion(const TestScene& test, Method method) {
    SceneParameters scene = measured(test, method, 4, 5);
    MeasurementOutput& output = *scene.measurements;
    output.quantities = {"diffusion"};
    output.give("correlation_steps", 12);
    return scene;
}

TestScene test_of(const Case& each) {
    TestScene test = gas(150, 0.15, 2, 79);
    test.setting.effects = each.effects;
    test.setting.box_height = 1.2 * test.setting.box_size;
    test.setting.micro_steps = 2;
    test.setting.sync_every = 12;
    test.steps = 60;
    return test;
}

struct Flying {
    DiscId id = 0;
    double x = 0, y = 0, vx = 0, vy = 0;
};

std::vector<Flying> all_flying(const DiscSystem& system, const Communicator& world) {
    std::vector<Flying> mine;
    const double unit = system.velocity_unit(), time = system.clock();
    for (const DiscState& disc : system.shown())
        mine.push_back({disc.id, disc.x_at(time), disc.y_at(time), disc.vx * unit, disc.vy * unit});
    std::vector<std::vector<Flying>> out(static_cast<std::size_t>(world.size()), mine);
    std::vector<Flying> all = send_to_owners(world, out).items;
    std::sort(all.begin(), all.end(), [](const Flying& a, const Flying& b) { return a.id < b.id; });
    return all;
}

/// Computed by hand: the run is sampled every step, in which no disc flies through half the box.
/// Along periodic axes positions are relative to the centre of mass.
struct ByHand {
    double period_x, period_y;
    std::vector<double> masses;
    std::vector<Flying> before{}, first{};
    std::vector<std::array<double, 2>> flown{};
    /// means over discs at each time of a window, one number for each window
    std::array<std::vector<double>, 4> squares{}, products{};

    void inspect(const std::vector<Flying>& now, std::size_t step) {
        const auto nearest = [](double d, double period) {
            return period == 0 ? d : std::remainder(d, period);
        };
        flown.resize(now.size());
        for (std::size_t i = 0; !before.empty() && i < now.size(); ++i) {
            flown[i][0] += nearest(now[i].x - before[i].x, period_x);
            flown[i][1] += nearest(now[i].y - before[i].y, period_y);
        }
        before = now;
        if (step % 4 != 0) return;
        if (step > 0) add(now, (step / 4 - 1) % 3 + 1);
        if (step % 12 != 0) return;
        first = now;
        for (auto& one : flown) one = {0, 0};
        add(now, 0);
    }
    /// The mean of `number(i)` over the discs, or 0 if walls stop the centre of mass.
    template <class Number> double centre(double period, const Number& number) const {
        double sum = 0, mass = 0;
        for (std::size_t i = 0; i < masses.size(); ++i) {
            sum += masses[i] * number(i);
            mass += masses[i];
        }
        return period == 0 ? 0 : sum / mass;
    }
    void add(const std::vector<Flying>& now, std::size_t time) {
        double square = 0, product = 0;
        const double x = centre(period_x, [&](std::size_t i) { return flown[i][0]; }),
                     y = centre(period_y, [&](std::size_t i) { return flown[i][1]; }),
                     ux = centre(period_x, [&](std::size_t i) { return first[i].vx; }),
                     uy = centre(period_y, [&](std::size_t i) { return first[i].vy; }),
                     vx = centre(period_x, [&](std::size_t i) { return now[i].vx; }),
                     vy = centre(period_y, [&](std::size_t i) { return now[i].vy; });
        for (std::size_t i = 0; i < now.size(); ++i) {
            square += std::pow(flown[i][0] - x, 2) + std::pow(flown[i][1] - y, 2);
            product += (first[i].vx - ux) * (now[i].vx - vx) +
                       (first[i].vy - uy) * (now[i].vy - vy);
        }
        squares[time].push_back(square / static_cast<double>(now.size()));
        products[time].push_back(product / static_cast<double>(now.size()));
    }
};

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

} // namespace

TEST_CASE("measurements: diffusion has the flights of all discs in windows") {
    const Communicator world = Communicator::world();
    for (const Case& each : cases()) {
        INFO(each.name);
        const TestScene test = test_of(each);
        const SceneParameters scene = with_diffusion(test, each.method);
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        ByHand expected{scene.effects.is_periodic_x() ? scene.box.x : 0,
                        scene.effects.is_periodic_y() ? scene.box.y : 0,
                        std::vector<double>(150, 1)};
        if (!each.effects.species.empty())
            std::fill(expected.masses.begin() + 100, expected.masses.end(), 7.0);
        for (std::int64_t step = 5; step <= 60; ++step) {
            advance_to(system, sampler, step);
            expected.inspect(all_flying(system, world), static_cast<std::size_t>(step - 5));
        }
        const std::vector<MeasuredTable> tables = sampler.tables();
        const std::vector<double> squares = column_of(tables, "velocity_autocorrelation",
                                                      "squares"),
                                  products = column_of(tables, "velocity_autocorrelation",
                                                       "velocities");
        CHECK(column_of(tables, "velocity_autocorrelation", "steps") ==
              std::vector<double>{0, 4, 8, 12});
        CHECK(column_of(tables, "velocity_autocorrelation", "count") ==
              std::vector<double>{5, 5, 4, 4});
        for (std::size_t time = 0; time < 4; ++time) {
            CHECK(squares[time] == Approx(mean_of(expected.squares[time])).epsilon(1e-12));
            CHECK(products[time] == Approx(mean_of(expected.products[time])).epsilon(1e-11));
        }
        double growth = 0;
        for (std::size_t k = 0; k < 4; ++k)
            growth += (expected.squares[3][k] - expected.squares[1][k]) / 4;
        CHECK(column_of(tables, "diffusion", "D")[0] == Approx(growth / (4 * 8)).epsilon(1e-11));
        CHECK(column_of(tables, "diffusion", "D_error")[0] > 0);
    }
}

TEST_CASE("measurements: diffusion goes on from what was stored, within a window") {
    const Communicator world = Communicator::world();
    for (const Case& each : cases()) {
        INFO(each.name);
        const TestScene test = test_of(each);
        const SceneParameters scene = with_diffusion(test, each.method);
        check_going_on(scene, test, 24, 60, world);
    }
}

TEST_CASE("measurements: diffusion is the same for who sees all discs drift") {
    const Communicator world = Communicator::world();
    const auto tables_with_drift = [&world](double drift) {
        TestScene test = gas(300, 0.3, 0.1, 81);
        test.setting.effects.boundaries.fill(seam);
        for (InputDisc& disc : test.discs) {
            disc.vx += drift;
            disc.vy -= drift / 2;
        }
        test.steps = 65;
        const SceneParameters scene = with_diffusion(test, Method::event_driven);
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        advance_to(system, sampler, 65);
        return sampler.tables();
    };
    // Rounding errors grow with each collision. In these few steps they stay far below the bound.
    const std::vector<MeasuredTable> still = tables_with_drift(0), drifting = tables_with_drift(3);
    for (const auto& [table, column] :
         {std::pair{"diffusion", "D"}, std::pair{"velocity_autocorrelation", "squares"},
          std::pair{"velocity_autocorrelation", "velocities"}}) {
        const std::vector<double> a = column_of(still, table, column),
                                  b = column_of(drifting, table, column);
        REQUIRE(a.size() == b.size());
        for (std::size_t k = 0; k < a.size(); ++k)
            CHECK(b[k] == Approx(a[k]).epsilon(1e-6).margin(1e-12));
    }
}

// Enskog: C(t) / C(0) begins as 1 - nu t, nu = 2 sqrt(pi) rho sigma g sqrt(kT), and D = kT / nu. It
// holds within some percent at this packing; g by Henderson (Mol. Phys. 30, 971 (1975)).
TEST_CASE("measurements: a gas diffuses as Enskog's theory says") {
    const Communicator world = Communicator::world();
    const double eta = 0.1;
    TestScene test = gas(800, eta, 0.1, 80);
    test.setting.effects.boundaries.fill(seam);
    test.steps = 6100;
    SceneParameters scene = with_diffusion(test, Method::event_driven);
    scene.measurements->every_steps = 2;
    scene.measurements->from_step = 100;
    scene.measurements->give("correlation_steps", 400);
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    advance_to(system, sampler, 6100);
    const std::vector<MeasuredTable> tables = sampler.tables();
    const std::vector<double> products = column_of(tables, "velocity_autocorrelation",
                                                   "velocities");
    const double kt = products[0] / 2, diameter = 2,
                 g = (1 - 7 * eta / 16) / ((1 - eta) * (1 - eta)),
                 density = 4 * eta / (std::numbers::pi * diameter * diameter),
                 nu = 2 * std::sqrt(std::numbers::pi) * density * diameter * g * std::sqrt(kt);
    for (std::size_t k = 1; k < 4; ++k) {
        const double t = 2 * static_cast<double>(k);
        CHECK(products[k] / products[0] == Approx(std::exp(-nu * t)).margin(0.012));
    }
    const double d = column_of(tables, "diffusion", "D")[0],
                 error = column_of(tables, "diffusion", "D_error")[0];
    CHECK(error < 0.04 * d);
    CHECK(std::fabs(d - kt / nu) < 4 * error + 0.05 * kt / nu);
}

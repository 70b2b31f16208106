// SPDX-License-Identifier: BSD-3-Clause
// Collision rates and pressures of hard discs between hard walls, compared with exact results and
// equations of state. docs/understanding/validation.md has sources and figures.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include <fmt/format.h>

#include "equations_of_state.hpp"
#include "gas_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Mean rates of collisions of two discs in a square box: Zapfe, Sanders, Rodriguez-Mota,
/// arXiv:1908.04749.
struct TwoDiscRates {
    double disc, wall;
};

TwoDiscRates two_disc_rates(double box_size, double sigma, double total_speed) {
    const double a = box_size - sigma, d = sigma, pi = std::numbers::pi;
    const double volume = a * a * a * a - pi * a * a * d * d + 8.0 / 3 * a * d * d * d -
                          d * d * d * d / 2;
    const double scale = 2 * total_speed / (3 * pi) / volume;
    return {scale * std::numbers::sqrt2 * (2 * pi * a * a * d - 8 * a * d * d + 2 * d * d * d),
            scale * (8 * a * a * a - 4 * pi * a * d * d + 16.0 / 3 * d * d * d)};
}

/// The value at 1/sqrt(N) = 0 of a parabola through three sizes, or of the best fit to more.
Estimate extrapolated(const std::vector<double>& sizes, const std::vector<Estimate>& values) {
    // Normal equations of a weighted fit by 1, u, u^2; the error is that of the first coefficient.
    std::array<std::array<double, 4>, 3> m{};
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        const double u = 1 / std::sqrt(sizes[k]), weight = 1 / (values[k].error * values[k].error);
        const std::array<double, 3> powers = {1, u, u * u};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) m[i][j] += weight * powers[i] * powers[j];
            m[i][3] += weight * powers[i] * values[k].value;
        }
    }
    const auto determinant = [&m](std::size_t a, std::size_t b, std::size_t c) {
        return m[0][a] * (m[1][b] * m[2][c] - m[1][c] * m[2][b]) -
               m[0][b] * (m[1][a] * m[2][c] - m[1][c] * m[2][a]) +
               m[0][c] * (m[1][a] * m[2][b] - m[1][b] * m[2][a]);
    };
    const double all = determinant(0, 1, 2);
    return {determinant(3, 1, 2) / all, std::sqrt((m[1][1] * m[2][2] - m[1][2] * m[2][1]) / all)};
}

void check_two_discs(double n_collisions) {
    const Communicator world = Communicator::world();
    fmt::print("| eta | R_disc | measured | R_wall | measured |\n|---|---|---|---|---|\n");
    for (const double eta : {0.1, 0.2, 0.3}) {
        const TestScene scene = crystal(2, eta, 7);
        DiscSystem system = event_driven_system(scene, world);
        run_until(system, 1000);
        const Totals before = system.totals();
        Averaging averaging(scene, system, world);
        run_until(system, n_collisions, averaging.actions());
        const Totals after = system.totals();
        const Averages averages = averaging.averages();
        const TwoDiscRates known = two_disc_rates(scene.setting.box_size, 2,
                                                  std::sqrt(2 * after.kinetic_energy));
        // There are two discs, so the collision rate of one disc is that of the pair.
        const Estimate disc = averages.collision_frequency;
        const double wall_rate = static_cast<double>(after.wall_collisions -
                                                     before.wall_collisions) /
                                 static_cast<double>(averages.steps);
        const Estimate wall{wall_rate, wall_rate * averages.wall_pressure.error /
                                           averages.wall_pressure.value};
        fmt::print("| {} | {:.6f} | {:.6f} +- {:.6f} | {:.6f} | {:.6f} +- {:.6f} |\n", eta,
                   known.disc, disc.value, disc.error, known.wall, wall.value, wall.error);
        CHECK(deviation(disc, known.disc) < 4);
        CHECK(deviation(wall, known.wall) < 4);
        CHECK(disc.error <
              6 / std::sqrt(n_collisions) *
                  disc.value); // three times the error for independent collisions of the pair
    }
}

void check_estimators(std::size_t n, const std::vector<double>& packings, double n_collisions) {
    const Communicator world = Communicator::world();
    for (const double eta : packings) {
        const GasProperties gas = measure_gas(n, eta, 100 * static_cast<double>(n), n_collisions,
                                              world);
        fmt::print("| {} | {} | {:.5f} +- {:.5f} | {:.5f} +- {:.5f} | {:+.1e} |\n", n, eta,
                   gas.wall_factor.value, gas.wall_factor.error, gas.virial_factor.value,
                   gas.virial_factor.error, gas.wall_factor.value / gas.virial_factor.value - 1);
        INFO("N = " << n << ", eta = " << eta);
        CHECK(deviation(gas.wall_factor, gas.virial_factor) < 4);
        CHECK(gas.wall_factor.error < 0.02 * gas.wall_factor.value);
    }
}

void check_bulk(const std::vector<double>& packings, const std::vector<double>& sizes,
                double n_collisions) {
    const Communicator world = Communicator::world();
    for (const double eta : packings) {
        std::vector<Estimate> factors, frequencies;
        for (const double n : sizes) {
            const GasProperties gas = measure_gas(static_cast<std::size_t>(n), eta, 100 * n,
                                                  n_collisions, world);
            factors.push_back(gas.virial_factor);
            frequencies.push_back(gas.frequency);
            fmt::print("| {} | {} | {:.5f} +- {:.5f} | | {:.5f} +- {:.5f} | |\n", eta, n,
                       gas.virial_factor.value, gas.virial_factor.error, gas.frequency.value,
                       gas.frequency.error);
        }
        const Estimate factor = extrapolated(sizes, factors),
                       frequency = extrapolated(sizes, frequencies);
        const KnownFactor known = known_factor(eta);
        // Enskog: nu sigma / sqrt(kT/m) = 4 (Z - 1) / sqrt(pi), exact in equilibrium.
        const double per_factor = 4 / std::sqrt(std::numbers::pi),
                     known_frequency = per_factor * (known.value - 1);
        fmt::print("| {} | bulk | {:.4f} +- {:.4f} | {:.4f} | {:.4f} +- {:.4f} | {:.4f} |\n", eta,
                   factor.value, factor.error, known.value, frequency.value, frequency.error,
                   known_frequency);
        INFO("eta = " << eta);
        CHECK(std::fabs(factor.value - known.value) < 4 * factor.error + known.error);
        CHECK(std::fabs(frequency.value - known_frequency) <
              4 * frequency.error + per_factor * known.error);
        CHECK(factor.error < 0.03 * factor.value);
    }
}

} // namespace

TEST_CASE("physics: two discs collide as often as they must") { check_two_discs(200000); }

TEST_CASE("physics: both estimators of the pressure agree") {
    check_estimators(4, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, 50000);
    check_estimators(64, {0.1, 0.3, 0.6}, 200000);
    check_estimators(1000, {0.3}, 1000000);
}

TEST_CASE("physics: pressure and collision frequency without walls") {
    check_bulk({0.3}, {64, 256, 1024}, 500000);
}

TEST_CASE("physics: two discs collide as often as they must, long", "[.long]") {
    check_two_discs(2e7);
}

TEST_CASE("physics: both estimators of the pressure agree, long", "[.long]") {
    fmt::print("| N | eta | Z (13c) | Z (19a) | difference |\n|---|---|---|---|---|\n");
    for (const std::size_t n : {4u, 64u, 1000u})
        check_estimators(n, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, n == 4 ? 5e6 : 2e7);
}

TEST_CASE("physics: pressure and collision frequency without walls, long", "[.long]") {
    fmt::print(
        "| eta | N | Z | known | nu sigma / sqrt(kT) | known |\n|---|---|---|---|---|---|\n");
    check_bulk({0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, {256, 1024, 4096}, 5e6);
}

// SPDX-License-Identifier: BSD-3-Clause
// Speeds of hard discs between hard walls: the microcanonical distribution, and how others come to it.
#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "gas_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

double kurtosis_of(std::span<const Disc> discs) {
    double square = 0, fourth = 0;
    for (const Disc& disc : discs) {
        const double v2 = disc.vx * disc.vx + disc.vy * disc.vy;
        square += v2;
        fourth += v2 * v2;
    }
    return static_cast<double>(discs.size()) * fourth / (square * square);
}

/// Largest distance between the distribution of the values and P(value < x) = 1 - (1 - x)^(n - 1).
double kolmogorov_distance(std::vector<double> values, double n) {
    std::sort(values.begin(), values.end());
    double largest = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double known = 1 - std::pow(1 - values[k], n - 1), count = static_cast<double>(values.size());
        largest = std::max({largest, known - static_cast<double>(k) / count, static_cast<double>(k + 1) / count - known});
    }
    return largest;
}

/// One disc of each of `n_looks` states, five collisions a disc apart: v^2 over the sum of all.
void check_distribution(std::size_t n, double n_looks) {
    const Communicator world = Communicator::world();
    Simulation simulation = exact_simulation(crystal(n, 0.3, 11), world);
    const double apart = 5 * static_cast<double>(n);
    double n_collisions = 20 * apart;
    run_until(simulation, n_collisions);
    const double energy = simulation.totals().kinetic_energy;
    std::vector<double> shares;
    for (double k = 0; k < n_looks; ++k) {
        n_collisions += apart;
        run_until(simulation, n_collisions);
        for (const Disc& disc : simulation.discs()) {
            if (disc.id == shares.size() % n) {
                shares.push_back((disc.vx * disc.vx + disc.vy * disc.vy) / (2 * energy));
                break;
            }
        }
    }
    const double distance = kolmogorov_distance(shares, static_cast<double>(n)) * std::sqrt(n_looks);
    fmt::print("| {} | {} | {:.3f} |\n", n, n_looks, distance);
    CHECK(shares.size() == static_cast<std::size_t>(n_looks));
    CHECK(distance < 1.95); // passed by one sample in a thousand (Kolmogorov)
}

void check_kurtosis(std::size_t n, double n_collisions) {
    const GasProperties gas = measure_gas(n, 0.3, 100 * static_cast<double>(n), n_collisions, Communicator::world());
    const double known = 2 * static_cast<double>(n) / static_cast<double>(n + 1);
    fmt::print("| {} | {:.4f} +- {:.4f} | {:.4f} |\n", n, gas.kurtosis.value, gas.kurtosis.error, known);
    CHECK(deviation(gas.kurtosis, known) < 4);
    CHECK(gas.kurtosis.error < 0.1);
}

/// Starts from speeds spread evenly between a and 2 a, as the ancestor's generator does, kurtosis 1.1388. It relaxes as
/// exp(-nu t / 4) near equilibrium (van Noije and Ernst, Granular Matter 1, 57 (1998), for elastic discs, first Sonine
/// approximation).
void check_relaxation(std::size_t n, double tolerance) {
    TestScene scene = crystal(n, 0.1, 12);
    Random random(13);
    for (InputDisc& disc : scene.discs) {
        const auto [ex, ey] = random.direction();
        const double speed = random.uniform(0.1, 0.2);
        disc.vx = speed * ex;
        disc.vy = speed * ey;
    }
    Simulation simulation = exact_simulation(scene, Communicator::world());
    const double discs = static_cast<double>(n), final = 2 * discs / (discs + 1), noise = 2 / std::sqrt(discs);
    const double start = kurtosis_of(simulation.discs());
    CHECK(std::fabs(start - 31.0 / 5 / (49.0 / 9)) < 4 / std::sqrt(discs));
    fmt::print("| collisions per disc | kurtosis |\n|---|---|\n| 0 | {:.4f} |\n", start);
    double at_two = 0, at_six = 0, last = start;
    for (const double per_disc : {1.0, 2.0, 4.0, 6.0, 10.0, 25.0}) {
        while (2 * static_cast<double>(simulation.totals().pair_collisions) < per_disc * discs) simulation.advance_towards(simulation.step() + 1);
        last = kurtosis_of(simulation.discs());
        fmt::print("| {} | {:.4f} |\n", per_disc, last);
        if (per_disc == 2) at_two = last;
        if (per_disc == 6) at_six = last;
    }
    const double rate = std::log((final - at_two) / (final - at_six)) / 4;
    fmt::print("decays as exp(-{:.3f} nu t); noise of one state {:.3f}\n", rate, noise);
    CHECK(std::fabs(rate - 0.25) < tolerance);
    CHECK(std::fabs(last - final) < 4 * noise);
}

} // namespace

TEST_CASE("physics: speeds have the microcanonical distribution") { check_distribution(16, 400); }
TEST_CASE("physics: the kurtosis of speeds is that of finitely many discs") {
    for (const std::size_t n : {4u, 64u}) check_kurtosis(n, 100000);
}
TEST_CASE("physics: the ancestor's speeds relax to Maxwell's") { check_relaxation(10000, 0.05); }

TEST_CASE("physics: speeds have the microcanonical distribution, long", "[.long]") {
    for (const std::size_t n : {4u, 64u}) check_distribution(n, 20000);
}
TEST_CASE("physics: the kurtosis of speeds is that of finitely many discs, long", "[.long]") {
    for (const std::size_t n : {4u, 16u, 64u, 1000u}) check_kurtosis(n, 5e6);
}
TEST_CASE("physics: the ancestor's speeds relax to Maxwell's, long", "[.long]") { check_relaxation(250000, 0.02); }

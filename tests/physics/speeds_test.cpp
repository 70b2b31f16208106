// SPDX-License-Identifier: BSD-3-Clause
// Speeds of hard discs between hard walls: the microcanonical distribution, and the relaxation
// towards it.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "catch.hpp"
#include <fmt/format.h>

#include "gas_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

double kurtosis_of(std::span<const DiscState> discs) {
    double square = 0, fourth = 0;
    for (const DiscState& disc : discs) {
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
        const double known = 1 - std::pow(1 - values[k], n - 1),
                     count = static_cast<double>(values.size());
        largest = std::max({largest, known - static_cast<double>(k) / count,
                            static_cast<double>(k + 1) / count - known});
    }
    return largest;
}

/// Takes one disc of each of `n_samples` states, five collisions a disc apart: v^2 divided by the
/// sum over all discs.
void check_distribution(std::size_t n, double n_samples) {
    const Communicator world = Communicator::world();
    DiscSystem system = event_driven_system(crystal(n, 0.3, 11), world);
    const double apart = 5 * static_cast<double>(n);
    double n_collisions = 20 * apart;
    run_until(system, n_collisions);
    const double energy = system.totals().kinetic_energy;
    std::vector<double> shares;
    for (double k = 0; k < n_samples; ++k) {
        n_collisions += apart;
        run_until(system, n_collisions);
        for (const DiscState& disc : system.discs()) {
            if (disc.id == shares.size() % n) {
                shares.push_back((disc.vx * disc.vx + disc.vy * disc.vy) / (2 * energy));
                break;
            }
        }
    }
    const double distance = kolmogorov_distance(shares, static_cast<double>(n)) *
                            std::sqrt(n_samples);
    fmt::print("| {} | {} | {:.3f} |\n", n, n_samples, distance);
    CHECK(shares.size() == static_cast<std::size_t>(n_samples));
    CHECK(distance < 1.95); // one sample in a thousand exceeds this (Kolmogorov)
}

void check_kurtosis(std::size_t n, double n_collisions) {
    const GasProperties gas = measure_gas(n, 0.3, 100 * static_cast<double>(n), n_collisions,
                                          Communicator::world());
    const double known = 2 * static_cast<double>(n) / static_cast<double>(n + 1);
    fmt::print("| {} | {:.4f} +- {:.4f} | {:.4f} |\n", n, gas.kurtosis.value, gas.kurtosis.error,
               known);
    CHECK(deviation(gas.kurtosis, known) < 4);
    CHECK(gas.kurtosis.error < 0.1);
}

/// Velocities with speeds spread evenly between 1 and 2, as the legacy generator makes them except
/// for a factor.
std::vector<std::pair<double, double>> legacy_velocities(std::size_t n, Random& random) {
    std::vector<std::pair<double, double>> velocities;
    for (std::size_t i = 0; i < n; ++i) {
        const auto [ex, ey] = random.direction();
        const double speed = random.uniform(1, 2);
        velocities.emplace_back(speed * ex, speed * ey);
    }
    return velocities;
}

/// The kurtosis after `per_disc` collisions per disc, if colliding discs are uncorrelated. That is
/// Boltzmann's equation without space, solved by Bird's direct simulation: random partners,
/// accepted in proportion to their relative speed.
std::vector<double> kurtosis_without_correlations(std::size_t n,
                                                  const std::vector<double>& per_disc) {
    Random random(14);
    std::vector<DiscState> discs(n);
    std::size_t i = 0;
    for (const auto& [vx, vy] : legacy_velocities(n, random)) {
        discs[i].vx = vx;
        discs[i++].vy = vy;
    }
    std::vector<double> kurtoses;
    double n_collisions = 0;
    for (const double until : per_disc) {
        while (2 * n_collisions < until * static_cast<double>(n)) {
            DiscState& p = discs[random.index(n)];
            DiscState& q = discs[random.index(n)];
            const double wx = q.vx - p.vx, wy = q.vy - p.vy, speed = std::sqrt(wx * wx + wy * wy);
            if (!(random.uniform(0, 12) < speed)) continue; // no relative speed reaches 12
            const double miss = random.uniform(-1, 1), head_on = std::sqrt(1 - miss * miss);
            const double ex = (wx * head_on - wy * miss) / speed,
                         ey = (wy * head_on + wx * miss) / speed;
            const double along = wx * ex + wy * ey;
            p.vx += along * ex;
            p.vy += along * ey;
            q.vx -= along * ex;
            q.vy -= along * ey;
            n_collisions += 1;
        }
        kurtoses.push_back(kurtosis_of(discs));
    }
    return kurtoses;
}

/// Starts from the course program's speeds, with a kurtosis of 1.1388, and compares the relaxation
/// to equilibrium with Boltzmann's equation.
void check_relaxation(std::size_t n, double packing) {
    TestScene scene = crystal(n, packing, 12);
    Random random(13);
    std::size_t i = 0;
    for (const auto& [vx, vy] : legacy_velocities(n, random)) {
        scene.discs[i].vx = 0.1 * vx;
        scene.discs[i++].vy = 0.1 * vy;
    }
    DiscSystem system = event_driven_system(scene, Communicator::world());
    const double discs = static_cast<double>(n), final = 2 * discs / (discs + 1),
                 noise = 2 / std::sqrt(discs);
    const double start = kurtosis_of(system.discs());
    CHECK(std::fabs(start - 31.0 / 5 / (49.0 / 9)) < 4 / std::sqrt(discs));
    fmt::print("| collisions per disc | kurtosis | Boltzmann's |\n|---|---|---|\n| 0 | {:.4f} | "
               "{:.4f} |\n",
               start, 279.0 / 245);
    const std::vector<double> numbers = {1, 2, 4, 6, 10, 25};
    const std::vector<double> known = kurtosis_without_correlations(4 * n, numbers);
    double last = 0;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        while (2 * static_cast<double>(system.totals().pair_collisions) < numbers[k] * discs)
            system.advance_towards(system.step() + 1);
        last = kurtosis_of(system.discs());
        fmt::print("| {} | {:.4f} | {:.4f} |\n", numbers[k], last, known[k]);
        // 1.2 times the bound of one number, because both have errors
        CHECK(std::fabs(last - known[k]) < 4 * 1.2 * noise);
    }
    fmt::print("noise of one state near equilibrium {:.4f}\n", noise);
    CHECK(std::fabs(last - final) < 4 * noise);
}

} // namespace

TEST_CASE("physics: speeds have the microcanonical distribution") { check_distribution(16, 400); }
TEST_CASE("physics: the kurtosis of speeds is that of finitely many discs") {
    for (const std::size_t n : {4u, 64u}) check_kurtosis(n, 100000);
}
TEST_CASE("physics: the course program's speeds relax to Maxwell's") {
    check_relaxation(10000, 0.1);
}

TEST_CASE("physics: speeds have the microcanonical distribution, long", "[.long]") {
    for (const std::size_t n : {4u, 64u}) check_distribution(n, 20000);
}
TEST_CASE("physics: the kurtosis of speeds is that of finitely many discs, long", "[.long]") {
    for (const std::size_t n : {4u, 16u, 64u, 1000u}) check_kurtosis(n, 5e6);
}
TEST_CASE("physics: the course program's speeds relax to Maxwell's, long", "[.long]") {
    check_relaxation(100000, 0.02);
}

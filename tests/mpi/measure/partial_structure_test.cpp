// SPDX-License-Identifier: BSD-3-Clause
// Partial structure factors against sums over all discs.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr std::size_t n_bins = 20;
constexpr double n_discs = 120;

TestScene mixed_gas() {
    TestScene test = gas(120, 0.3, 0.7, 79);
    test.setting.effects.boundaries.fill({BoundaryKind::periodic, 1, 0, 0});
    test.setting.effects.species = {{20, 1, 2}, {70, 0.5, 1}, {30, 0.8, 1}};
    test.steps = 20;
    return test;
}

SceneParameters with_waves(const TestScene& test, double largest) {
    SceneParameters scene = measured(test, Method::event_driven, 5, 5);
    scene.measurements->quantities = {"partial_structure_factor", "structure_factor"};
    scene.measurements->give("largest_wavenumber", largest);
    return scene;
}

std::size_t species_of(DiscId id) { return id < 20 ? 0 : id < 90 ? 1 : 2; }

/// Sums of S_ab over the vectors of each bin, by a + 3 b, and their number.
struct ByHand {
    std::vector<std::vector<double>> sums = std::vector<std::vector<double>>(
        9, std::vector<double>(n_bins, 0));
    std::vector<double> counts = std::vector<double>(n_bins, 0);

    void add(const std::vector<SeenDisc>& discs, const Box& box, double largest) {
        const double kx = 2 * std::numbers::pi / box.x, ky = 2 * std::numbers::pi / box.y;
        const int n_most = static_cast<int>(largest / kx) + 1;
        for (int n = -n_most; n <= n_most; ++n) {
            for (int m = -n_most; m <= n_most; ++m) {
                const double k = std::hypot(kx * n, ky * m);
                if (k > largest || k == 0) continue;
                std::vector<std::complex<double>> modes(3, 0);
                for (const SeenDisc& disc : discs)
                    modes[species_of(disc.id)] += std::polar(1.0,
                                                             kx * n * disc.x + ky * m * disc.y);
                const auto bin = static_cast<std::size_t>(k / largest * n_bins);
                counts[bin] += 0.5;
                for (std::size_t kind = 0; kind < 9; ++kind)
                    sums[kind][bin] += (modes[kind % 3] * std::conj(modes[kind / 3])).real() /
                                       (2 * n_discs);
            }
        }
    }
};

} // namespace

TEST_CASE("measurements: partial structure factors are those of sums over all discs") {
    const Communicator world = Communicator::world();
    const TestScene test = mixed_gas();
    const double largest = 8.7 * 2 * std::numbers::pi / test.setting.box_size;
    const SceneParameters scene = with_waves(test, largest);
    DiscSystem system = system_of(scene, test, world);
    Sampler sampler(scene, system, world);
    ByHand expected;
    for (std::int64_t step = 5; step <= 20; step += 5) {
        advance_to(system, sampler, step);
        expected.add(seen_discs(system, world), scene.box, largest);
    }
    const std::vector<MeasuredTable> tables = sampler.tables();
    const std::vector<double> all = column_of(tables, "structure_factor", "S");
    std::vector<double> sum(n_bins, 0);
    for (std::size_t b = 0; b < 3; ++b) {
        for (std::size_t a = 0; a <= b; ++a) {
            const std::vector<double> s = column_of(tables, "partial_structure_factor",
                                                    "S_" + std::to_string(a + 1) + '_' +
                                                        std::to_string(b + 1));
            for (std::size_t bin = 0; bin < n_bins; ++bin) {
                sum[bin] += (a == b ? 1 : 2) * s[bin];
                if (expected.counts[bin] == 0)
                    CHECK(std::isnan(s[bin]));
                else
                    CHECK(s[bin] == Approx(expected.sums[a + 3 * b][bin] / expected.counts[bin])
                                        .epsilon(1e-10)
                                        .margin(1e-12));
            }
        }
    }
    for (std::size_t bin = 0; bin < n_bins; ++bin)
        if (expected.counts[bin] > 0) CHECK(sum[bin] == Approx(all[bin]).epsilon(1e-10));
}

TEST_CASE("measurements: partial structure factors go on from what was stored") {
    const Communicator world = Communicator::world();
    const TestScene test = mixed_gas();
    check_going_on(with_waves(test, 2), test, 12, 20, world);
}

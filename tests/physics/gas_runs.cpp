// SPDX-License-Identifier: BSD-3-Clause
#include "gas_runs.hpp"

#include <cmath>
#include <numbers>

#include <omp.h>

namespace carrom::test {

TestScene crystal(std::size_t n, double packing, std::uint64_t seed) {
    Random random(seed);
    const double size = std::sqrt(static_cast<double>(n) * std::numbers::pi / packing);
    TestScene scene = empty_scene("crystal", size, 1, 1);
    const auto k = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(n))));
    const double spacing = size / static_cast<double>(k);
    for (std::size_t i = 0; i < n; ++i) {
        add_disc(scene, (static_cast<double>(i % k) + 0.5) * spacing,
                 (static_cast<double>(i / k) + 0.5) * spacing);
    }
    set_speeds(scene, 2, random);
    return scene;
}

DiscSystem event_driven_system(const TestScene& scene, const Communicator& world) {
    SceneParameters all = scene_of(scene);
    all.method = Method::event_driven;
    Tuning tuning;
    tuning.threads = omp_get_max_threads();
    return {all, world.is_root() ? scene.discs : std::vector<InputDisc>{}, world, tuning};
}

void run_until(DiscSystem& system, double n_collisions, std::span<StepAction* const> actions) {
    std::int64_t stride = 1;
    for (double done = 0; done < n_collisions;) {
        advance_to(system, system.step() + stride, actions);
        const Totals totals = system.totals();
        done = static_cast<double>(totals.wall_collisions + totals.pair_collisions);
        const double per_step = std::max(done, 1.0) / static_cast<double>(system.step());
        stride = std::max<std::int64_t>(
            1, static_cast<std::int64_t>(std::min((n_collisions - done) / per_step,
                                                  4.0 * static_cast<double>(system.step()))));
    }
}

GasProperties measure_gas(std::size_t n, double packing, double n_early, double n_collisions,
                          const Communicator& world) {
    const TestScene scene = crystal(n, packing,
                                    1000 * n + static_cast<std::uint64_t>(100 * packing));
    DiscSystem system = event_driven_system(scene, world);
    run_until(system, n_early);
    Averaging averaging(scene, system, world);
    run_until(system, n_early + n_collisions, averaging.actions());
    const Averages averages = averaging.averages();
    const double energy = system.totals().kinetic_energy;
    const double area = scene.setting.box_size * scene.setting.box_size;
    const double thermal_speed = std::sqrt(energy / static_cast<double>(n));
    const auto scaled = [](const Estimate& estimate, double factor) {
        return Estimate{estimate.value * factor, estimate.error * factor};
    };
    return {scaled(averages.wall_pressure, area / energy),
            scaled(averages.virial_pressure, area / energy),
            scaled(averages.collision_frequency, 2 / thermal_speed), averages.speed_kurtosis};
}

double deviation(const Estimate& a, const Estimate& b) {
    return std::fabs(a.value - b.value) / std::hypot(a.error, b.error);
}

double deviation(const Estimate& measured, double known) {
    return std::fabs(measured.value - known) / measured.error;
}

} // namespace carrom::test

// SPDX-License-Identifier: BSD-3-Clause
// Averages over a run compared with plain sums over all discs.
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include <omp.h>

#include "averaging.hpp"
#include "gathered.hpp"
#include "scene_tools.hpp"
#include "simulation/disc_statistics.hpp"

using namespace carrom;

namespace {

struct PlainSums {
    double walls = 0, pairs = 0, speed = 0, square = 0, fourth = 0;

    double kurtosis() const { return 100 * fourth / (square * square); }
};

PlainSums sums_of(const std::vector<DiscState>& discs, double velocity_unit) {
    PlainSums sums;
    for (const DiscState& disc : discs) {
        const double speed = velocity_unit * std::hypot(disc.vx, disc.vy);
        sums.walls += static_cast<double>(disc.wall_collisions);
        sums.pairs += static_cast<double>(disc.pair_collisions) / 2;
        sums.speed += speed;
        sums.square += speed * speed;
        sums.fourth += std::pow(speed, 4);
    }
    return sums;
}

struct MeanAndError {
    double mean, error;
};

MeanAndError over_blocks(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double mean = 0, squares = 0;
    for (const double value : values) mean += value / n;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return {mean, std::sqrt(squares / (n * (n - 1)))};
}

} // namespace

TEST_CASE("averages: the ratio of gamma functions") {
    for (const double n : {1.0, 2.0, 7.0, 63.0, 64.0, 65.0, 100.0}) {
        CHECK(gamma_ratio(n) == Approx(std::tgamma(n + 0.5) / std::tgamma(n)).epsilon(1e-13));
    }
    CHECK(gamma_ratio(1e8) == Approx(std::sqrt(1e8) * (1 - 1 / 8e8)).epsilon(1e-15));
}

namespace {

/// Equations (13c) and (19a) of Li et al. 2022 for a box of side L, with kT = R^2 / (2 N): 100
/// discs, 41 steps.
void check_pressures(const Averages& averages, const test::TestScene& test, const PlainSums& first,
                     const PlainSums& now) {
    const double size = test.setting.box_size, radius = test.setting.radius,
                 r = std::sqrt(now.square);
    const double g = std::exp(std::lgamma(100.5) - std::lgamma(100.0)),
                 per_time = std::sqrt(std::numbers::pi) / r * g / 41;
    const double walls = now.walls - first.walls, pairs = now.pairs - first.pairs,
                 temperature = now.square / 200;
    CHECK(averages.wall_pressure.value ==
          Approx(temperature * per_time * walls / (2 * size)).epsilon(1e-10));
    CHECK(averages.virial_pressure.value ==
          Approx(temperature * (100 + radius * per_time * (walls + std::sqrt(2.0) * pairs)) /
                 (size * size))
              .epsilon(1e-10));
}

/// The integral of stress so far. tests/physics/virial_test.cpp compares it with logged collisions.
Tensor stress_of(const DiscSystem& system) {
    MotionSample sample = motion_sample(system);
    integrate(system, system.stress_sums(), sample);
    return sample.stress;
}

/// For the 41 steps of 100 discs below. Integrals are per micro-step; a step has 4 of them.
void check_tensor(const Averages& averages, const Tensor& first, const Tensor& last, double area,
                  double square) {
    CHECK(averages.pressure_tensor.xx.value ==
          Approx(4 * (last.xx - first.xx) / (41 * area)).epsilon(1e-10));
    CHECK(std::fabs(averages.pressure_tensor.xy.value - 4 * (last.xy - first.xy) / (41 * area)) <
          1e-10 * averages.pressure.value);
    CHECK(averages.temperature.value == Approx(square / 200).epsilon(1e-10)); // kept
    CHECK(averages.compressibility.value ==
          Approx(averages.pressure.value * area / (100 * averages.temperature.value)));
}

/// The discs of the list that this rank gets.
std::vector<InputDisc> own_of(const std::vector<InputDisc>& discs, const Communicator& world) {
    std::vector<InputDisc> mine;
    for (const InputDisc& disc : discs)
        if (static_cast<int>(disc.id) % world.size() == world.rank()) mine.push_back(disc);
    return mine;
}

void check_frequency(const Averages& averages, double pairs, const std::vector<double>& by_block) {
    CHECK(averages.n_blocks == static_cast<std::int64_t>(by_block.size()));
    CHECK(averages.collision_frequency.value == Approx(2 * pairs / 4100).epsilon(1e-13));
    CHECK(averages.collision_frequency.error >= over_blocks(by_block).error * (1 - 1e-12));
    CHECK(averages.collision_frequency.error < 3 * over_blocks(by_block).error);
    CHECK(averages.mean_free_time.value == Approx(4100 / (2 * pairs)).epsilon(1e-13));
}

} // namespace

TEST_CASE("averages: counts, speeds, pressures and errors are those of plain sums") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        test::TestScene test = test::gas(100, 0.3, 0.3, 71);
        test.steps = 48;
        test.setting.micro_steps = 4;
        test.setting.sync_every = 10; // a sync in every second or third step
        SceneParameters scene = test::scene_of(test);
        scene.method = method;
        Tuning tuning;
        tuning.threads = omp_get_max_threads();
        DiscSystem system(scene, own_of(test.discs, world), world, tuning);
        test::Averaging averaging(scene, system, world);
        averaging.advance_to(7);
        averaging.begin_anew();
        const PlainSums first = sums_of(gathered(system.discs(), world), 4);
        const Tensor first_stress = stress_of(system);
        // Samples are 10 steps apart, a quarter of the run, because the run is short and conserves
        // its energy.
        PlainSums at_block = first, at_sample = first, now;
        std::int64_t block_begin = 7, sample_step = 7;
        std::vector<double> frequencies, speeds;
        double all_speeds = 0, all_kurtoses = 0;
        for (std::int64_t step = 8; step <= 48; ++step) {
            averaging.advance_to(step);
            const bool is_end = step % 10 == 7;
            if (!is_end && step < 48) continue;
            now = sums_of(gathered(system.discs(), world), 4);
            const double half = static_cast<double>(step - sample_step) / 2;
            const double speed = half * (at_sample.speed + now.speed) / 100;
            all_speeds += speed;
            all_kurtoses += half * (at_sample.kurtosis() + now.kurtosis());
            at_sample = now;
            sample_step = step;
            if (!is_end) continue;
            const auto steps = static_cast<double>(step - block_begin);
            frequencies.push_back(2 * (now.pairs - at_block.pairs) / (100.0 * steps));
            speeds.push_back(speed / steps);
            at_block = now;
            block_begin = step;
        }
        const Averages averages = averaging.averages();
        CHECK(averages.first_step == 7);
        CHECK(averages.steps == 41);
        check_frequency(averages, now.pairs - first.pairs, frequencies);
        CHECK(averages.mean_speed.value == Approx(all_speeds / 41).epsilon(1e-11));
        CHECK(averages.mean_speed.error >= over_blocks(speeds).error * (1 - 1e-6));
        CHECK(averages.speed_kurtosis.value == Approx(all_kurtoses / 41).epsilon(1e-11));

        check_tensor(averages, first_stress, stress_of(system),
                     test.setting.box_size * test.setting.box_size, now.square);
        check_pressures(averages, test, first, now);
    }
}

TEST_CASE("averages: any number of blocks ends as 64 to 127, and stops on the way change nothing") {
    const Communicator world = Communicator::world();
    test::TestScene test = test::gas(4, 0.2, 0.3, 72);
    test.setting.sync_every = 2;
    test.steps = 10000;
    const auto averages_of = [&](std::int64_t stride) {
        DiscSystem system(test::scene_of(test),
                          world.is_root() ? test.discs : std::vector<InputDisc>{}, world, {});
        test::Averaging averaging(test, system, world);
        for (std::int64_t step = 0; step < 10000;) {
            step = std::min<std::int64_t>(step + stride, 10000);
            averaging.advance_to(step);
        }
        return averaging.averages();
    };
    const Averages once = averages_of(10000), often = averages_of(7);
    CHECK(once.n_blocks == 10000 / 128);
    CHECK(often.n_blocks == once.n_blocks);
    CHECK(often.wall_pressure.value == once.wall_pressure.value);
    CHECK(often.wall_pressure.error == once.wall_pressure.error);
    CHECK(often.speed_kurtosis.value == once.speed_kurtosis.value);
    CHECK(often.collision_frequency.error == once.collision_frequency.error);
    CHECK(often.pressure.value == once.pressure.value);
    CHECK(often.pressure_tensor.xy.error == once.pressure_tensor.xy.error);
    CHECK(once.temperature.is_conserved); // averaged over many whole flights
}

TEST_CASE("averages: discs at rest, or none that collide, give numbers and no error") {
    const Communicator world = Communicator::world();
    test::TestScene test = test::empty_scene("discs at rest", 10, 1, 1);
    test::add_disc(test, 3, 5);
    test::add_disc(test, 7, 5);
    DiscSystem system(test::scene_of(test), world.is_root() ? test.discs : std::vector<InputDisc>{},
                      world, {});
    test::Averaging averaging(test, system, world);
    CHECK(averaging.averages().steps == 0);
    CHECK(std::isnan(averaging.averages().pressure.value));
    averaging.advance_to(1);
    const Averages averages = averaging.averages();
    CHECK(averages.wall_pressure.value == 0);
    CHECK(averages.collision_frequency.value == 0);
    CHECK(averages.mean_speed.value == 0);
    CHECK(std::isnan(averages.wall_pressure.error));
    CHECK(averages.temperature.value == 0);
    CHECK(averages.pressure.value == 0);
    CHECK(std::isnan(averages.compressibility.value));
}

TEST_CASE("averages: they begin where the scene says, and a short run has errors") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        test::TestScene test = test::gas(50, 0.3, 0.5, 74);
        test.steps = 40;
        SceneParameters scene = test::scene_of(test);
        scene.method = method;
        scene.averages_from = 15;
        DiscSystem system(scene, world.is_root() ? test.discs : std::vector<InputDisc>{}, world,
                          {});
        test::Averaging averaging(scene, system, world);
        averaging.advance_to(9);
        CHECK(averaging.averages().steps == 0);
        averaging.advance_to(40);
        const Averages averages = averaging.averages();
        CHECK(averages.first_step == 15);
        CHECK(averages.steps == 25);
        CHECK(averages.n_blocks == 4);
        CHECK(averages.pressure.error > 0);
        CHECK(averages.pressure.error < averages.pressure.value);
    }
}

TEST_CASE("averages: a run planned for a million steps has errors after some collisions") {
    const Communicator world = Communicator::world();
    test::TestScene test = test::gas(50, 0.3, 0.5, 75);
    test.steps = 1'000'000;
    SceneParameters scene = test::scene_of(test);
    scene.method = Method::event_driven;
    DiscSystem system(scene, world.is_root() ? test.discs : std::vector<InputDisc>{}, world, {});
    test::Averaging averaging(scene, system, world);
    averaging.advance_to(15);
    CHECK(averaging.averages().pressure.is_short);
    CHECK(std::isnan(averaging.averages().pressure.error));
    averaging.advance_to(16);
    const Averages first = averaging.averages();
    CHECK(first.n_blocks == 16);
    CHECK(first.collision_frequency.value * 16 < 32);
    CHECK(first.pressure.error > 0);
    CHECK(first.mean_speed.is_short);
    CHECK(reason_without_error(first.mean_speed, first).starts_with("too short: an error takes"));
    averaging.advance_to(500); // blocks of 4 steps
    const Averages later = averaging.averages();
    CHECK(later.n_blocks == 125);
    CHECK(later.mean_speed.error > 0);
    CHECK(later.pressure.error < first.pressure.error);
}

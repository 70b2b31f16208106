// SPDX-License-Identifier: BSD-3-Clause
// The share of collisions that the time-stepped method loses at a given number of collisions per
// disc and micro-step, compared with a table. A separate program made the table: 256 discs, hard
// walls; rates have errors up to 1.2 %, mostly common to a column.
#include "catch.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "initial_state/initial_state.hpp"
#include "run/pilot/trial.hpp"

using namespace carrom;

namespace {

constexpr int n_starts = 3;
constexpr double table_error = 0.012;

/// 256 discs of diameter 1 that each collide once in four steps; `frequency` is the collision rate
/// at kT = 1 in this box.
SceneParameters known_gas(double packing, double frequency, std::uint64_t seed) {
    SceneParameters scene;
    scene.name = "known gas";
    scene.n_discs = 256;
    scene.radius = 0.5;
    scene.box = std::sqrt(256 * std::numbers::pi / 4 / packing);
    scene.speed = std::numbers::sqrt2 * 0.25 / frequency;
    scene.seed = seed;
    return scene;
}

/// A mean over starts and its standard error.
struct Mean {
    double value = 0, error = 0;
};

Mean mean_of(const std::vector<double>& terms) {
    const auto n = static_cast<double>(terms.size());
    double sum = 0, squares = 0;
    for (const double term : terms) sum += term;
    for (const double term : terms) squares += (term - sum / n) * (term - sum / n);
    return {sum / n, std::sqrt(squares / (n * (n - 1)))};
}

struct LossOfMethod {
    Mean rate, overlaps; ///< rate: pair collisions relative to the event-driven method;
                         ///< overlaps: number of discs that a disc overlaps
};

LossOfMethod measure(double packing, double frequency, const RunSetting& setting,
                     const Communicator& world) {
    static std::map<std::pair<double, int>, std::pair<TrialStart, double>>
        exact; ///< results of the event-driven method, by packing and start
    std::vector<double> rates, overlaps;
    for (int start = 0; start < n_starts; ++start) {
        const SceneParameters scene = known_gas(packing, frequency,
                                                100 + static_cast<std::uint64_t>(start));
        TrialLength length;
        length.steps = 1200; // some 300 collisions a disc
        auto& [begin, rate] = exact[{packing, start}];
        if (begin.discs.empty()) {
            begin = bring_to_equilibrium(scene, initial_state(scene, nullptr, world), 20, world,
                                         {});
            rate = static_cast<double>(
                run_trial(scene, {Method::event_driven}, begin, length, world, {})
                    .totals.pair_collisions);
        }
        const Trial trial = run_trial(scene, setting, begin, length, world, {});
        rates.push_back(static_cast<double>(trial.totals.pair_collisions) / rate);
        overlaps.push_back(trial.overlapping_pairs_per_disc);
    }
    return {mean_of(rates), mean_of(overlaps)};
}

/// The scatter of three starts is a poor estimate of the error. So the error is at least the
/// counting error of both runs.
double error_of_rate(const Mean& mean) {
    return std::max(mean.error, std::sqrt(2.0 / (n_starts * 256 * 150)));
}

struct KnownLoss {
    double rate, overlaps;
};
struct Column {
    double packing, frequency;
    /// Losses at 1/4, 1/8, ... 1/128 collisions per disc and micro-step
    std::array<KnownLoss, 6> losses;
};
const std::array<Column, 3> table = {{
    {0.1,
     0.5394,
     {{{.762, .090}, {.870, .051}, {.933, .026}, {.971, .0145}, {.986, .0072}, {1.003, .0032}}}},
    {0.3,
     2.4595,
     {{{.644, .320}, {.753, .219}, {.855, .131}, {.912, .084}, {.972, .040}, {.990, .025}}}},
    {0.5,
     7.2255,
     {{{.470, .597}, {.540, .489}, {.636, .362}, {.709, .260}, {.798, .176}, {.861, .126}}}},
}};

} // namespace

TEST_CASE(
    "the time-stepped method loses as many collisions, and leaves as many overlaps, as is known") {
    const Communicator world = Communicator::world();
    for (const Column& column : table) {
        for (std::size_t i = 0; i < column.losses.size(); ++i) {
            const LossOfMethod loss = measure(column.packing, column.frequency,
                                              {Method::time_stepped, std::int64_t{1} << i}, world);
            const KnownLoss& known = column.losses[i];
            CAPTURE(column.packing, 4 << i, loss.rate.value, loss.rate.error, known.rate,
                    loss.overlaps.value, loss.overlaps.error, known.overlaps);
            CHECK(std::fabs(loss.rate.value - known.rate) <
                  4 * std::hypot(table_error, error_of_rate(loss.rate)));
            // The table has no errors of overlaps, so the counting error of 200 overlaps is
            // assumed.
            const double noise = known.overlaps * std::hypot(1 / std::sqrt(200.0), table_error);
            CHECK(std::fabs(loss.overlaps.value - known.overlaps) <
                  4 * std::hypot(noise, loss.overlaps.error));
        }
    }
}

TEST_CASE("errors fall in first order when discs are few, more slowly when they are dense") {
    const Communicator world = Communicator::world();
    const auto order = [&](const Column& column) { // exponent of the loss between 1/4 and 1/32
        const Mean coarse =
            measure(column.packing, column.frequency, {Method::time_stepped, 1}, world).rate;
        const Mean fine =
            measure(column.packing, column.frequency, {Method::time_stepped, 8}, world).rate;
        const double lost_coarse = 1 - coarse.value, lost_fine = 1 - fine.value;
        return Mean{
            std::log(lost_coarse / lost_fine) / std::log(8.0),
            std::hypot(error_of_rate(coarse) / lost_coarse, error_of_rate(fine) / lost_fine) /
                std::log(8.0)};
    };
    const Mean dilute = order(table[0]), dense = order(table[2]);
    CAPTURE(dilute.value, dilute.error, dense.value, dense.error);
    // From the table: log(0.238 / 0.029) / log(8) = 1.01, with an error of 0.012 of the smaller
    // loss; log(0.530 / 0.291) / log(8) = 0.288 +- 0.021.
    CHECK(std::fabs(dilute.value - 1.01) < 4 * std::hypot(dilute.error, 0.20));
    CHECK(dilute.value > 0.75);
    CHECK(std::fabs(dense.value - 0.288) < 4 * std::hypot(dense.error, 0.021));
}

TEST_CASE("precision and formula change no rate where discs are near to each other") {
    const Communicator world = Communicator::world();
    const Column& column = table[1];
    const LossOfMethod usual = measure(column.packing, column.frequency, {Method::time_stepped, 4},
                                       world);
    for (const Precision precision : {Precision::double_, Precision::single}) {
        for (const bool contraction : {false, true}) {
            const RunSetting setting{Method::time_stepped, 4, precision, Arithmetic::naive,
                                     contraction};
            const LossOfMethod loss = measure(column.packing, column.frequency, setting, world);
            CAPTURE(precision == Precision::single, contraction, loss.rate.value, usual.rate.value);
            CHECK(std::fabs(loss.rate.value - usual.rate.value) <
                  4 * std::hypot(error_of_rate(loss.rate), error_of_rate(usual.rate)));
        }
    }
}

TEST_CASE("under the event-driven method no precision and no formula changes the rate, and the "
          "stable one "
          "leaves no overlaps") {
    const Communicator world = Communicator::world();
    for (const Column& column : table) {
        for (const Precision precision : {Precision::double_, Precision::single}) {
            for (const Arithmetic arithmetic : {Arithmetic::stable, Arithmetic::naive}) {
                const LossOfMethod loss = measure(column.packing, column.frequency,
                                                  {Method::event_driven, 2, precision, arithmetic},
                                                  world);
                CAPTURE(column.packing, precision == Precision::single,
                        arithmetic == Arithmetic::naive, loss.rate.value, loss.rate.error);
                CHECK(std::fabs(loss.rate.value - 1) < 4 * error_of_rate(loss.rate));
                if (arithmetic == Arithmetic::stable) CHECK(loss.overlaps.value == 0);
            }
        }
    }
}

TEST_CASE("single precision rounds every state, keeps energy to its own rounding, and says so in "
          "the bits") {
    const Communicator world = Communicator::world();
    const SceneParameters scene = known_gas(0.3, 2.4595, 7);
    const TrialStart start = bring_to_equilibrium(scene, initial_state(scene, nullptr, world), 5,
                                                  world, {});
    const TrialLength length{200, 200, 1};
    const Trial usual = run_trial(scene, {Method::time_stepped, 2}, start, length, world, {});
    const Trial single = run_trial(scene, {Method::time_stepped, 2, Precision::single}, start,
                                   length, world, {});
    CHECK_FALSE(usual.totals.hash == single.totals.hash);
    CHECK(std::fabs(single.totals.kinetic_energy / usual.totals.kinetic_energy - 1) <
          256 * 0x1p-24);
    bool all_are_floats = true, is_double = false;
    for (const InputDisc& disc : single.early)
        for (const double number : {disc.vx, disc.vy})
            all_are_floats = all_are_floats && static_cast<float>(number) == number;
    for (const InputDisc& disc : usual.early)
        is_double = is_double || static_cast<float>(disc.vx) != disc.vx;
    CHECK(all_are_floats);
    CHECK(is_double);
}

TEST_CASE("micro-steps by a power of two are exact scaling: the same bits as velocities divided by "
          "hand") {
    const Communicator world = Communicator::world();
    for (const auto& [method, k] : {std::pair{Method::time_stepped, std::int64_t{2}},
                                    {Method::time_stepped, 8},
                                    {Method::time_stepped, 64},
                                    {Method::event_driven, 8}}) {
        SceneParameters scene = known_gas(0.3, 2.4595, 11);
        scene.method = method;
        scene.steps = 40;
        scene.micro_steps = k;
        std::vector<InputDisc> discs = initial_state(scene, nullptr, world);
        DiscSystem scaled(scene, discs, world, {});
        while (scaled.step() < 40) scaled.advance_towards(40);
        for (InputDisc& disc : discs) {
            disc.vx /= static_cast<double>(k);
            disc.vy /= static_cast<double>(k);
        }
        scene.micro_steps = 1;
        scene.steps = 40 * k;
        DiscSystem by_hand(scene, discs, world, {});
        while (by_hand.step() < scene.steps) by_hand.advance_towards(scene.steps);
        CHECK(scaled.totals().pair_collisions > 100);
        CHECK(scaled.totals().hash == by_hand.totals().hash);
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Correlations over decades of time, compared with frames of all discs, pair by pair; also in runs
// with a restart between samples.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"

#include "measured_runs.hpp"
#include "parallel/exchange.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr int n_correlated = 1300; ///< more than the ids in one rank's run
constexpr int n_light = 1100, sample_steps = 2, last_sample = 90;

using SeenFrame = std::vector<SeenDisc>; ///< the discs of a frame, in the order of ids

double mass_of_mixture(DiscId id) { return id < n_light ? 1 : 4; }

/// Makes positions continuous by nearest images, relative to the centre of mass.
void unwrap(std::vector<SeenFrame>& frames, double side) {
    for (std::size_t t = 1; t < frames.size(); ++t)
        for (std::size_t i = 0; i < frames[t].size(); ++i) {
            SeenDisc& now = frames[t][i];
            const SeenDisc& before = frames[t - 1][i];
            now.x -= side * std::round((now.x - before.x) / side);
            now.y -= side * std::round((now.y - before.y) / side);
        }
    for (SeenFrame& frame : frames)
        for (double SeenDisc::* field :
             {&SeenDisc::x, &SeenDisc::y, &SeenDisc::vx, &SeenDisc::vy}) {
            double sum = 0, mass = 0;
            for (const SeenDisc& disc : frame)
                sum += mass_of_mixture(disc.id) * disc.*field, mass += mass_of_mixture(disc.id);
            for (SeenDisc& disc : frame) disc.*field -= sum / mass;
        }
}

constexpr int all_samples = last_sample + 1;

/// The expected columns from "count" on, without errors, for ids from `begin` to `end` and origins
/// from `first` to before `last`.
std::vector<double> correlations_of(const std::vector<SeenFrame>& frames, int lag, int spacing,
                                    int begin, int end, double k, double overlap, int first = 0,
                                    int last = all_samples) {
    double r2 = 0, r4 = 0, vv = 0, waves = 0, q = 0, q2 = 0;
    const double n = end - begin;
    int count = 0;
    for (int t = 0; t + lag < static_cast<int>(frames.size()); t += spacing) {
        if (t < first || t >= last) continue;
        double near = 0;
        for (int i = begin; i < end; ++i) {
            const SeenDisc
                &a = frames[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)],
                &b = frames[static_cast<std::size_t>(t + lag)][static_cast<std::size_t>(i)];
            const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
            r2 += square / n;
            r4 += square * square / n;
            vv += (a.vx * b.vx + a.vy * b.vy) / n;
            waves += (std::cos(k * dx) + std::cos(k * dy)) / (2 * n);
            near += std::sqrt(square) < overlap ? 1 / n : 0;
        }
        q += near;
        q2 += near * near;
        ++count;
    }
    r2 /= count, r4 /= count, vv /= count, waves /= count, q /= count, q2 /= count;
    return {static_cast<double>(count), r2, vv, waves, r4 / (2 * r2 * r2) - 1, q, n * (q2 - q * q)};
}

TestScene correlated_mixture(bool is_periodic) {
    TestScene test = gas(n_correlated, 0.2, 0.6, 17);
    test.setting.effects.species = {{n_light, test.setting.radius, 1},
                                    {n_correlated - n_light, test.setting.radius, 4}};
    if (is_periodic)
        for (Boundary& side : test.setting.effects.boundaries) side.kind = BoundaryKind::periodic;
    test.setting.sync_every = 16;
    test.steps = sample_steps * last_sample;
    return test;
}

SceneParameters with_correlations(const TestScene& test, Method method) {
    SceneParameters scene = measured(test, method, sample_steps);
    scene.measurements->quantities = {"correlations"};
    scene.measurements->give("correlation_points", 4);
    scene.measurements->give("correlation_wavenumber", 0.7 / scene.radius);
    scene.measurements->give("overlap_distance", 2 * scene.radius);
    return scene;
}

} // namespace

TEST_CASE("measurements: correlations are those of frames, pair by pair") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        const TestScene test = correlated_mixture(true);
        const SceneParameters scene = with_correlations(test, method);
        DiscSystem system = system_of(scene, test, world);
        Sampler sampler(scene, system, world);
        std::vector<SeenFrame> frames;
        for (int sample = 0; sample <= last_sample; ++sample) {
            advance_to(system, sampler, sample_steps * sample);
            frames.push_back(seen_discs(system, world));
        }
        unwrap(frames, scene.box.x);
        const std::vector<MeasuredTable> tables = sampler.tables();
        REQUIRE(tables.size() == 6);
        const int ends[][2] = {{0, n_correlated}, {0, n_light}, {n_light, n_correlated}};
        for (std::size_t table = 0; table < 3; ++table) {
            INFO(tables[table].name);
            // lags 1, 2, 3, 4, then 6, 8, 12, 16 ... 64; 96 is too long
            REQUIRE(tables[table].rows.size() == 12);
            for (const std::vector<double>& row : tables[table].rows) {
                const int lag = static_cast<int>(row[0]) / sample_steps;
                int spacing = 1;
                while (4 * spacing < lag) spacing *= 2;
                const std::vector<double> expected = correlations_of(
                    frames, lag, spacing, ends[table][0], ends[table][1], 0.7 / scene.radius,
                    2 * scene.radius);
                const std::vector<double> found = {row[1], row[2], row[4], row[6],
                                                   row[8], row[9], row[11]};
                INFO(lag);
                CHECK(found[0] == expected[0]);
                for (std::size_t k = 1; k < found.size(); ++k)
                    CHECK(found[k] == Approx(expected[k]).epsilon(1e-12).margin(1e-12));
            }
            const MeasuredTable& waiting = tables[3 + table];
            INFO(waiting.name);
            double n_origins = 0;
            for (const std::vector<double>& row : waiting.rows) {
                const int from = static_cast<int>(row[0]) / sample_steps,
                          to = static_cast<int>(row[1]) / sample_steps,
                          lag = static_cast<int>(row[2]) / sample_steps;
                CHECK(to == std::max(1, 2 * from));
                int spacing = 1;
                while (4 * spacing < lag) spacing *= 2;
                const std::vector<double> expected = correlations_of(
                    frames, lag, spacing, ends[table][0], ends[table][1], 0.7 / scene.radius,
                    2 * scene.radius, from, to);
                INFO(from << " " << lag);
                CHECK(row[3] == expected[0]);
                CHECK(row[4] == Approx(expected[1]).epsilon(1e-12));
                CHECK(row[6] == Approx(expected[3]).epsilon(1e-12).margin(1e-12));
                CHECK(row[8] == Approx(expected[5]).epsilon(1e-12).margin(1e-12));
                n_origins += row[3];
            }
            double expected_origins = 0;
            for (const std::vector<double>& row : tables[table].rows) expected_origins += row[1];
            CHECK(n_origins == expected_origins);
        }
    }
}

TEST_CASE("measurements: correlations go on between samples") {
    const Communicator world = Communicator::world();
    for (const bool is_periodic : {true, false}) {
        const TestScene test = correlated_mixture(is_periodic);
        const SceneParameters scene = with_correlations(test, Method::event_driven);
        check_going_on(scene, test, 75, test.steps, world);
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// The pressure tensor compared with equations of state in periodic boxes, with the walls' pressure,
// and with sums over logged collisions. docs/understanding/pressure.md derives the formulas.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"
#include <fmt/format.h>

#include "engine/engine.hpp"
#include "equations_of_state.hpp"
#include "gas_runs.hpp"
#include "parallel/exchange.hpp"
#include "simulation/disc_statistics.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

void make_periodic(TestScene& scene) {
    for (Boundary& side : scene.setting.effects.boundaries) side.kind = BoundaryKind::periodic;
}

/// Averages over about this many collisions, in equilibrium.
Averages averages_of(TestScene scene, double n_early, double n_collisions,
                     const Communicator& world) {
    scene.steps = 1 << 20;
    DiscSystem system = event_driven_system(scene, world);
    run_until(system, n_early);
    Averaging averaging(scene, system, world);
    run_until(system, n_early + n_collisions, averaging.actions());
    return averaging.averages();
}

/// The expected Z of N discs in a periodic box: the bulk's Z, and the first term in 1/N.
KnownFactor periodic_factor(double eta, double n) {
    const auto pressure = [](double x) { return x * known_factor(x).value; };
    constexpr double h = 1e-3;
    const double slope = (pressure(eta + h) - pressure(eta - h)) / (2 * h);
    const double bend = (pressure(eta + h) - 2 * pressure(eta) + pressure(eta - h)) / (h * h);
    KnownFactor known = known_factor(eta);
    known.value -= eta * bend / slope / (2 * n);
    return known;
}

void check_periodic(double eta, std::size_t n, double n_collisions, double largest_error) {
    const Communicator world = Communicator::world();
    TestScene scene = crystal(n, eta, 5 + n);
    make_periodic(scene);
    for (InputDisc& disc : scene.discs) disc.vx += 0.5; // a drift does not count as heat
    const Averages averages = averages_of(scene, 60 * static_cast<double>(n), n_collisions, world);
    const Estimate z = averages.compressibility;
    const KnownFactor known = periodic_factor(eta, static_cast<double>(n));
    fmt::print("| {} | {} | {:.5f} +- {:.5f} | {:.5f} | {:+.1f} |\n", eta, n, z.value, z.error,
               known.value, (z.value - known.value) / std::hypot(z.error, known.error));
    INFO("eta = " << eta << ", N = " << n);
    CHECK(std::fabs(z.value - known.value) < 4 * z.error + known.error);
    CHECK(z.error < largest_error * z.value);
    // The pressure is half the trace of the tensor, and there is no shear stress.
    const TensorEstimate& p = averages.pressure_tensor;
    CHECK(averages.pressure.value == Approx((p.xx.value + p.yy.value) / 2).epsilon(1e-13));
    CHECK(std::fabs(p.xy.value) < 4 * p.xy.error);
    CHECK(std::fabs(p.xx.value - p.yy.value) < 4 * std::hypot(p.xx.error, p.yy.error));
    CHECK(averages.compressibility.value ==
          Approx(averages.pressure.value * std::pow(scene.setting.box_size, 2) /
                 (static_cast<double>(n) * averages.temperature.value))
              .epsilon(1e-12));
}

/// The sums of discs' impulses on each side.
struct NormalImpulses : WallFollower {
    void take(std::span<const WallEvent> events) override {
        for (const WallEvent& event : events) sums[event.side] += event.normal;
    }
    std::array<double, 4> sums{};
};

/// Compares with the means of both walls along x, and along y, over the averaged time.
void check_walls(TestScene scene, double n_collisions) {
    const Communicator world = Communicator::world();
    scene.steps = 1 << 20;
    DiscSystem system = event_driven_system(scene, world);
    const double n = static_cast<double>(scene.discs.size());
    run_until(system, 60 * n);
    Averaging averaging(scene, system, world);
    const std::int64_t first = system.step();
    NormalImpulses impulses;
    system.engine().followers_of_walls().add(impulses);
    run_until(system, 60 * n + n_collisions, averaging.actions());
    system.engine().followers_of_walls().forget(impulses);
    const Averages averages = averaging.averages();
    const double size = scene.setting.box_size, steps = static_cast<double>(system.step() - first);
    const double room = 1 - 2 * scene.setting.radius / size;
    const TensorEstimate& p = averages.pressure_tensor;
    const auto wall = [&](std::size_t side) {
        return (impulses.sums[side] + impulses.sums[side + 1]) / (2 * size * steps);
    };
    INFO(scene.name);
    fmt::print(
        "{}: xx {:.6g} +- {:.2g}, from walls {:.6g}; yy {:.6g} +- {:.2g}, from walls {:.6g}\n",
        scene.name, p.xx.value, p.xx.error, wall(0) * room, p.yy.value, p.yy.error, wall(2) * room);
    if (!scene.setting.effects.is_periodic_x())
        CHECK(std::fabs(p.xx.value - wall(0) * room) < 4 * p.xx.error);
    CHECK(std::fabs(p.yy.value - wall(2) * room) < 4 * p.yy.error);
    CHECK(p.xx.error < 0.02 * p.xx.value);
}

struct State {
    std::vector<DiscState> discs;
    double clock = 0;
};

/// All discs by id, on every rank.
State state_of(const DiscSystem& system, const Communicator& world) {
    State state;
    stream_to_root(
        world, system.shown(),
        [&](std::span<const DiscState> some) {
            state.discs.insert(state.discs.end(), some.begin(), some.end());
        },
        1000);
    world.broadcast(state.discs);
    std::sort(state.discs.begin(), state.discs.end(),
              [](const DiscState& a, const DiscState& b) { return a.id < b.id; });
    state.clock = system.clock();
    return state;
}

/// m v_a v_b times `time`.
Tensor flown(double mass, const DiscState& disc, double time) {
    return (mass * time) * Tensor{disc.vx * disc.vx, disc.vx * disc.vy, disc.vy * disc.vy};
}

MotionSample integrated(const DiscSystem& system) {
    MotionSample sample = motion_sample(system);
    integrate(system, system.stress_sums(), sample);
    return sample;
}

double mass_of(const TestScene& scene, DiscId id) {
    for (const Species& one : scene.setting.effects.species) {
        if (id < one.count) return one.mass;
        id -= one.count;
    }
    return 1;
}

/// A step in which no disc collides twice, and the expected change of the integrals.
struct Step {
    State before, after;
    double end = 0; ///< end of the step, in steps
    Tensor stress, kinetic;
    double size = 0; ///< typical size of a term
    int n_pairs = 0;
};

/// Each disc flies with its velocity before the step until its collision, and then with the
/// velocity after the step.
void add_flights(const TestScene& scene, const std::vector<Collision>& log, Step& step) {
    for (const DiscState& disc : step.before.discs) {
        const double mass = mass_of(scene, disc.id);
        step.kinetic += flown(mass, disc, 1);
        step.size += mass * squared_speed_of(disc);
    }
    for (const Collision& c : log) {
        const double left = step.end - static_cast<double>(c.micro_step) - c.time;
        for (const DiscId id : {c.p, c.q}) {
            if (id == Collision::wall) continue;
            step.kinetic += flown(mass_of(scene, id), step.after.discs[id], left);
            step.kinetic += flown(mass_of(scene, id), step.before.discs[id], -left);
        }
    }
    step.stress += step.kinetic;
}

/// For a disc that has collided once in a step, the impulse follows from its velocities before and
/// after, and the place of the collision from the logged time and the state before.
void add_pairs(const TestScene& scene, const std::vector<Collision>& log, Step& step) {
    const Periods periods = scene.setting.effects.periods(scene.setting.box_size);
    const auto nearest = [](double d, double period) {
        return period == 0 ? d : d - period * std::round(d / period);
    };
    for (const Collision& c : log) {
        if (c.q == Collision::wall) continue;
        const double into = c.time + static_cast<double>(c.micro_step) - (step.end - 1),
                     clock = step.before.clock;
        const DiscState &p = step.before.discs[c.p], &q = step.before.discs[c.q];
        const double ex = nearest((q.x_at(clock) + q.vx * into) - (p.x_at(clock) + p.vx * into),
                                  periods.x),
                     ey = nearest((q.y_at(clock) + q.vy * into) - (p.y_at(clock) + p.vy * into),
                                  periods.y);
        const double mass = mass_of(scene, c.p), ix = mass * (step.after.discs[c.p].vx - p.vx),
                     iy = mass * (step.after.discs[c.p].vy - p.vy);
        step.stress += {-ix * ex, -(ix * ey + iy * ex) / 2, -iy * ey};
        step.size += std::hypot(ix, iy) * std::hypot(ex, ey);
        ++step.n_pairs;
    }
}

bool has_second_hits(const std::vector<Collision>& log, std::size_t n_discs) {
    std::vector<int> n_hits(n_discs);
    for (const Collision& c : log) {
        n_hits[c.p] += 1;
        if (c.q != Collision::wall) n_hits[c.q] += 1;
    }
    return std::any_of(n_hits.begin(), n_hits.end(), [](int n) { return n > 1; });
}

/// Compares single steps.
void check_against_log(const TestScene& scene, Method method) {
    const Communicator world = Communicator::world();
    SceneParameters all = scene_of(scene);
    all.method = method;
    DiscSystem system(all, world.is_root() ? scene.discs : std::vector<InputDisc>{}, world, {});
    std::vector<Collision> log;
    system.log_to(&log);
    int n_pairs = 0;
    INFO(scene.name);
    while (system.step() < scene.steps) {
        Step step;
        step.before = state_of(system, world);
        const MotionSample sample_before = integrated(system);
        log.clear();
        system.advance_towards(system.step() + 1);
        step.after = state_of(system, world);
        step.end = static_cast<double>(system.step());
        if (has_second_hits(log, step.before.discs.size())) continue;
        add_flights(scene, log, step);
        add_pairs(scene, log, step);
        n_pairs += step.n_pairs;
        const MotionSample sample = integrated(system);
        for (double Tensor::* part : {&Tensor::xx, &Tensor::xy, &Tensor::yy})
            CHECK(std::fabs(sample.stress.*part - sample_before.stress.*part - step.stress.*part) <=
                  1e-10 * step.size);
        CHECK(std::fabs(sample.energy - sample_before.energy - step.kinetic.xx - step.kinetic.yy) <=
              1e-10 * step.size);
    }
    CHECK(n_pairs > 15);
}

} // namespace

TEST_CASE("physics: the integral of stress is the sum over collisions and flights") {
    const ContactEffect lossy{ContactKind::restitution, 0.6};
    const ContactEffect rough{ContactKind::rough, 0.8, 0.001, 0.4, 0.3, 0.5};
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        for (const bool is_periodic : {false, true}) {
            for (const int kind : {0, 1, 2, 3}) {
                TestScene scene = gas(36, 0.3, 0.004, 300 + static_cast<std::uint64_t>(kind));
                scene.name = fmt::format("kind {}, periodic {}, method {}", kind, is_periodic,
                                         static_cast<int>(method));
                scene.steps = 300;
                if (is_periodic) make_periodic(scene);
                Effects& effects = scene.setting.effects;
                if (kind == 1) effects.contact = lossy;
                if (kind >= 2) effects.contact = rough;
                if (kind == 3) effects.species = {{10, 1, 3}, {26, 0.9, 0.5}};
                check_against_log(scene, method);
            }
        }
    }
}

TEST_CASE("physics: the pressure in a periodic box is that of the equation of state") {
    fmt::print("| eta | N | Z | known | deviation |\n|---|---|---|---|---|\n");
    for (const double eta : {0.1, 0.3, 0.5}) check_periodic(eta, 1024, 1.5e6, 1.5e-3);
}

TEST_CASE("physics: few discs in a periodic box have the pressure of so few") {
    // Here 1/N makes 0.027, and a kinetic part without the lost degree of freedom would make 0.016
    // more.
    check_periodic(0.5, 64, 2e6, 1.5e-3);
    check_periodic(0.3, 36, 1e6, 1.5e-3);
}

TEST_CASE("physics: the pressure in a box is that on its walls") {
    check_walls(crystal(64, 0.3, 61), 4e5);
    check_walls(crystal(100, 0.6, 62), 4e5);
    TestScene rough = crystal(64, 0.3, 63);
    rough.name = "rough discs";
    rough.setting.effects.contact = {
        ContactKind::rough, 1, 0.001, 1, std::numeric_limits<double>::infinity(), 0.5};
    check_walls(rough, 4e5);
    TestScene channel = crystal(100, 0.4, 64);
    channel.name = "without walls along x";
    channel.setting.effects.boundaries[0].kind = channel.setting.effects.boundaries[1].kind =
        BoundaryKind::periodic;
    check_walls(channel, 4e5);
}

TEST_CASE("physics: the pressure in a periodic box is that of the equation of state, long",
          "[.long]") {
    fmt::print("| eta | N | Z | known | deviation |\n|---|---|---|---|---|\n");
    for (const double eta : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}) check_periodic(eta, 4096, 1e8, 1.5e-4);
}

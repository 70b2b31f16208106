// SPDX-License-Identifier: BSD-3-Clause
// The GPU engine with its kernels on the CPU: it has the bits of the brute-force reference in the
// scenes that tests share, and its sums equal those of the CPU engine.
#include <cstdlib>
#include <memory>
#include <optional>

#include "catch.hpp"

#include "core/state_hash.hpp"
#include "engine/state_sums.hpp"
#include "gpu/gpu.hpp"
#include "gpu/serial_device.hpp"
#include "scene_tools.hpp"
#include "scenes.hpp"
#include "time_stepped.hpp"
#include "time_stepped/time_stepped_engine.hpp"

using namespace carrom;

namespace {

StoredState state_of(const test::TestScene& scene) {
    StoredState state;
    for (const DiscState& disc : reference::stored_states(scene.setting, scene.discs))
        state.discs.push_back(disc);
    return state;
}

/// In a build with CUDA a variable of the environment takes the tests to a GPU.
const DeviceKind& tested_device() {
    return std::getenv("CARROM_TEST_GPU") ? *program_gpu().device : serial_device();
}

std::unique_ptr<Engine> device_engine(const SceneParameters& scene, StoredState state,
                                      const Tuning& tuning = {}) {
    return make_gpu_engine_on(tested_device(), scene, std::move(state), Communicator::world(),
                              tuning);
}
std::unique_ptr<Engine> cpu_engine(const SceneParameters& scene, StoredState state,
                                   const Tuning& tuning = {}) {
    return make_time_stepped_engine(scene, std::move(state), Communicator::world(), tuning);
}

/// Everything that must be equal in two engines at a step.
struct Sums {
    Totals totals;
    double stress[4] = {};
};

Sums run(Engine& engine, std::int64_t last_step, std::int64_t micro_steps) {
    Sums sums;
    StressSums stress(0x1p40);
    engine.add_stress_to(&stress);
    while (engine.micro_steps_done() < last_step * micro_steps) engine.advance_towards(last_step);
    measure_collisions(engine.own(), engine.side_columns(), Communicator::world(), 1, sums.totals);
    engine.add_to(sums.totals);
    for (std::size_t k = 0; k < 4; ++k) sums.stress[k] = stress.parts()[k]->value();
    engine.add_stress_to(nullptr);
    return sums;
}

void check_same(const Sums& device, const Sums& cpu) {
    CHECK(device.totals.hash == cpu.totals.hash);
    CHECK(device.totals.pair_collisions == cpu.totals.pair_collisions);
    CHECK(device.totals.wall_collisions == cpu.totals.wall_collisions);
    CHECK(device.totals.rejected_candidates == cpu.totals.rejected_candidates);
    CHECK(device.totals.overlapping_pairs == cpu.totals.overlapping_pairs);
    CHECK(device.totals.deepest_overlap == cpu.totals.deepest_overlap);
    for (std::size_t k = 0; k < 4; ++k) CHECK(device.stress[k] == cpu.stress[k]);
}

void compare_engines(const SceneParameters& scene, const StoredState& state,
                     const Tuning& tuning = {}) {
    const std::unique_ptr<Engine> device = device_engine(scene, state, tuning),
                                  cpu = cpu_engine(scene, state);
    check_same(run(*device, scene.steps, scene.micro_steps),
               run(*cpu, scene.steps, scene.micro_steps));
}

void check_against_reference(const std::vector<test::TestScene>& scenes) {
    std::size_t number = 0;
    for (const test::TestScene& scene : scenes) {
        INFO(scene.name);
        reference::TimeSteppedReference reference(scene.setting, scene.discs);
        reference.run_steps(scene.steps);
        const std::optional<double> windows[] = {std::nullopt, 1.0, 4.0, 64.0};
        Tuning tuning;
        tuning.window = windows[number++ % 4];
        SceneParameters parameters = test::scene_of(scene);
        parameters.method = Method::time_stepped;
        const std::unique_ptr<Engine> engine = device_engine(parameters, state_of(scene), tuning);
        while (engine->micro_steps_done() < scene.steps * parameters.micro_steps)
            engine->advance_towards(scene.steps);
        CHECK(hash_of(engine->own()) == hash_of(reference.discs()));
    }
}

/// A gas with these effects, of discs of these species, or of one size.
test::TestScene gas_with(const Effects& effects, double speed, std::uint64_t seed) {
    test::Random random(seed);
    test::TestScene scene = test::empty_scene("gas", 36, 1, 24);
    scene.setting.effects = effects;
    const bool round_x = effects.is_periodic_x(), round_y = effects.is_periodic_y();
    if (effects.species.empty())
        test::add_gas(scene, 144, random);
    else
        test::add_species(scene, round_x, round_y, random);
    for (InputDisc& disc : scene.discs) {
        const auto [x, y] = random.direction();
        disc.vx = speed * x;
        disc.vy = speed * y;
    }
    return scene;
}

const Boundary seam{BoundaryKind::periodic, 1, 0, 0};

} // namespace

TEST_CASE("kernels of GPUs give the reference's bits on every small scene") {
    check_against_reference(test::small_scenes());
}

TEST_CASE("kernels of GPUs give the reference's bits on large scenes") {
    // A device in threads of this processor is slow: every third scene.
    std::vector<test::TestScene> some;
    for (std::size_t k = 0; const test::TestScene& scene : test::large_scenes())
        if (k++ % 3 == 0) some.push_back(scene);
    check_against_reference(some);
}

TEST_CASE("an engine of GPUs adds up what one of CPUs does, with effects") {
    for (const bool is_mixed : {false, true})
        for (const double restitution : {1.0, 0.8})
            for (const int n_round : {0, 1, 2})
                for (const double speed : {0.02, 0.4, 3.0}) {
                    Effects effects;
                    if (is_mixed) effects.species = {{20, 1, 4}, {40, 0.7, 1}, {60, 0.4, 0.5}};
                    if (restitution < 1)
                        effects.contact = {ContactKind::restitution, restitution, 0};
                    if (n_round > 0) effects.boundaries[2] = effects.boundaries[3] = seam;
                    if (n_round > 1) effects.boundaries[0] = effects.boundaries[1] = seam;
                    INFO("species " << is_mixed << ", restitution " << restitution << ", "
                                    << n_round << " axes periodic, speed " << speed);
                    const test::TestScene scene = gas_with(effects, speed, 57);
                    SceneParameters parameters = test::scene_of(scene);
                    parameters.method = Method::time_stepped;
                    compare_engines(parameters, state_of(scene));
                }
}

TEST_CASE("an engine of GPUs gives the bits of studied arithmetic") {
    for (const Precision precision : {Precision::double_, Precision::single})
        for (const Arithmetic arithmetic : {Arithmetic::stable, Arithmetic::naive})
            for (const bool contraction : {false, true}) {
                if (contraction && arithmetic == Arithmetic::stable) continue;
                const test::TestScene scene = gas_with({}, 0.5, 58);
                SceneParameters parameters = test::scene_of(scene);
                parameters.method = Method::time_stepped;
                parameters.precision = precision;
                parameters.arithmetic = arithmetic;
                parameters.contraction = contraction;
                compare_engines(parameters, state_of(scene));
            }
}

TEST_CASE("a run goes from a CPU to a GPU and back in mid-run") {
    Effects effects;
    effects.boundaries = {seam, seam, Boundary{}, Boundary{}};
    const test::TestScene scene = gas_with(effects, 0.3, 59);
    SceneParameters parameters = test::scene_of(scene);
    parameters.method = Method::time_stepped;
    const std::unique_ptr<Engine> whole = cpu_engine(parameters, state_of(scene));
    while (whole->micro_steps_done() < scene.steps * parameters.micro_steps)
        whole->advance_towards(scene.steps);
    StoredState state = state_of(scene);
    bool is_on_device = true;
    for (const std::int64_t stop : {std::int64_t{5}, std::int64_t{11}, scene.steps}) {
        const std::unique_ptr<Engine> part = is_on_device
                                                 ? device_engine(parameters, std::move(state))
                                                 : cpu_engine(parameters, std::move(state));
        while (part->micro_steps_done() < stop * parameters.micro_steps)
            part->advance_towards(stop);
        state = {};
        state.micro_steps_done = part->micro_steps_done();
        for (const DiscState& disc : part->own()) state.discs.push_back(disc);
        is_on_device = !is_on_device;
    }
    CHECK(hash_of(state.discs) == hash_of(whole->own()));
}

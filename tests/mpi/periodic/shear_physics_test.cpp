// SPDX-License-Identifier: BSD-3-Clause
// Known results for uniform shear: nothing depends on the position of the seam or on the frame, the
// velocity profile is a straight line, and stresses agree with kinetic theory.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include <omp.h>

#include "averaging.hpp"
#include "effect_runs.hpp"
#include "periodic_scenes.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

/// Bits do not depend on the machine shape, so long runs are made only on small shapes.
bool is_left_to_small_shapes(const Communicator& world) {
    return world.size() * omp_get_max_threads() > 2;
}

constexpr Boundary sliding{BoundaryKind::sheared, 1, 0, 0};

/// A gas with the flow from the start. `rate` is relative to the speed of its discs divided by the
/// diameter.
TestScene flowing_gas(std::size_t n, double packing, double rate, double restitution) {
    TestScene scene = gas(n, packing, 0.1, 911);
    scene.setting.effects.boundaries = {periodic, periodic, sliding, sliding};
    scene.setting.effects.contact = {ContactKind::restitution, restitution, 1e-9};
    double square = 0;
    for (const InputDisc& disc : scene.discs) square += disc.vx * disc.vx + disc.vy * disc.vy;
    const double thermal = std::sqrt(square / (2 * static_cast<double>(n)));
    scene.setting.effects.shear = rate * thermal / (2 * scene.setting.radius);
    for (InputDisc& disc : scene.discs)
        disc.vx += scene.setting.effects.flow_at(disc.y, scene.setting.box());
    return scene;
}

Averages averages_of(const TestScene& scene, Method method, const Communicator& world) {
    DiscSystem system = system_of(scene, method, world);
    Averaging averaging(scene, system, world);
    averaging.advance_to(scene.steps);
    return averaging.averages();
}

TensorEstimate stresses_of(const TestScene& scene, Method method, const Communicator& world) {
    return averages_of(scene, method, world).pressure_tensor;
}

/// The same flow, shifted upwards by `up`. Discs that cross the seam get the velocity of their row.
TestScene lifted(TestScene scene, double up) {
    const double height = scene.setting.box().y, rate = scene.setting.effects.shear;
    for (InputDisc& disc : scene.discs) {
        disc.y += up;
        disc.vx += rate * up;
        if (disc.y < height) continue;
        disc.y -= height;
        disc.vx -= rate * height;
    }
    return scene;
}

} // namespace

// Rounding errors grow by a factor of about e in each collision. There are four collisions per
// disc, so the errors stay small.
TEST_CASE("shear: stresses depend neither on the frame nor on where the seam is") {
    const Communicator world = Communicator::world();
    for (const Method method : {Method::time_stepped, Method::event_driven}) {
        TestScene scene = flowing_gas(200, 0.3, 0.5, 0.9);
        scene.steps = 20;
        const TensorEstimate expected = stresses_of(scene, method, world);
        CHECK(expected.xy.value < 0);
        TestScene moving = scene;
        for (InputDisc& disc : moving.discs) disc.vx += 0.3;
        for (const TestScene& other : {moving, lifted(scene, 0.37 * scene.setting.box().y)}) {
            const TensorEstimate found = stresses_of(other, method, world);
            CHECK(found.xx.value == Approx(expected.xx.value).epsilon(1e-7));
            CHECK(found.xy.value == Approx(expected.xy.value).epsilon(1e-7));
            CHECK(found.yy.value == Approx(expected.yy.value).epsilon(1e-7));
        }
    }
}

namespace {

/// The viscosity in units of sqrt(m kT) / diameter, by Gass (1971).
double enskog_viscosity(double packing) {
    const double bn = 2 * packing, chi = (1 - 7 * packing / 16) / ((1 - packing) * (1 - packing));
    return 1.022 / (2 * std::sqrt(std::numbers::pi)) * (1 / chi + bn + 0.8729 * chi * bn * bn);
}

} // namespace

// In each of ten layers the mean of vx minus the line has an error of sqrt(T / n), where n counts a
// layer's discs in all samples; four times that is allowed. Samples are several collisions apart.
TEST_CASE("shear: the profile of velocities is a line") {
    const Communicator world = Communicator::world();
    if (is_left_to_small_shapes(world)) return;
    TestScene scene = flowing_gas(1000, 0.3, 0.5, 0.9);
    scene.steps = 2000;
    DiscSystem system = system_of(scene, Method::event_driven, world);
    const double height = scene.setting.box().y, rate = scene.setting.effects.shear;
    std::array<double, 10> sums{}, squares{}, counts{};
    for (std::int64_t step = 500; step <= scene.steps; step += 50) {
        advance_to(system, step);
        for (const DiscState& disc : system.shown()) {
            const auto layer = std::min<std::size_t>(
                9, static_cast<std::size_t>(10 * disc.y / height));
            const double over = disc.vx - rate * (disc.y - height / 2);
            sums[layer] += over;
            squares[layer] += over * over;
            counts[layer] += 1;
        }
    }
    const auto over_ranks = [&](std::array<double, 10>& numbers) {
        std::array<double, 10> all{};
        for (const auto& part : world.all_gather(numbers))
            for (std::size_t k = 0; k < all.size(); ++k) all[k] += part[k];
        numbers = all;
    };
    for (auto* numbers : {&sums, &squares, &counts}) over_ranks(*numbers);
    double total = 0, number = 0;
    for (std::size_t k = 0; k < sums.size(); ++k) total += sums[k], number += counts[k];
    for (std::size_t k = 0; k < sums.size(); ++k)
        CHECK(std::fabs(sums[k] / counts[k] - total / number) <
              4 * std::sqrt(squares[k]) / counts[k]);
}

// At restitution 0.99 the temperature is the one at which the work of the flow equals the losses.
// The rate is 0.13 of the thermal speed per diameter. Four standard errors are 0.06 of the
// viscosity.
TEST_CASE("shear: the viscosity is Enskog's") {
    const Communicator world = Communicator::world();
    if (is_left_to_small_shapes(world)) return;
    TestScene scene = flowing_gas(1000, 0.3, 0.135, 0.99);
    scene.steps = 4000;
    const Averages averages = averages_of(scene, Method::event_driven, world);
    const double viscosity = -averages.pressure_tensor.xy.value / scene.setting.effects.shear,
                 unit = std::sqrt(averages.temperature.value) / (2 * scene.setting.radius);
    CHECK(viscosity / unit == Approx(enskog_viscosity(0.3)).epsilon(0.08));
}

// Elastic discs: a thermostat that rescales velocities relative to the flow takes the
// energy that the flow gives. It keeps kT relative to the flow constant, except for the mean
// velocity, a share of 1 / n.
TEST_CASE("shear: elastic discs whose velocities are rescaled have Enskog's viscosity") {
    const Communicator world = Communicator::world();
    if (is_left_to_small_shapes(world)) return;
    TestScene scene = flowing_gas(1000, 0.3, 0.1, 1);
    // The thermostat uses the initial temperature, so the rate is right from the start.
    const double thermal = scene.setting.effects.shear * 2 * scene.setting.radius / 0.1,
                 kt = thermal * thermal;
    scene.setting.effects.thermostat = {ThermostatKind::rescale, 0, 0, kt, 0};
    scene.setting.sync_every = 8;
    scene.steps = 4000;
    const Averages averages = averages_of(scene, Method::event_driven, world);
    CHECK(averages.temperature.value == Approx(kt).epsilon(0.005));
    const double viscosity = -averages.pressure_tensor.xy.value / scene.setting.effects.shear,
                 unit = std::sqrt(kt) / (2 * scene.setting.radius);
    CHECK(viscosity / unit == Approx(enskog_viscosity(0.3)).epsilon(0.08));
}

// Grad's moments of a dilute gas (Vega Reyes, Santos and Garzo, J. Fluid Mech. 719, 431 (2013)):
// with the cooling rate zeta and beta in units of the rate of viscous relaxation, -Pxy / Pyy is the
// root of zeta / beta. The finite density changes that by some per cent, and the errors are as
// large.
TEST_CASE("shear: a granular gas has the stress ratio of Grad's moments") {
    const Communicator world = Communicator::world();
    if (is_left_to_small_shapes(world)) return;
    const double e = 0.8, zeta = (1 - e * e) / 2, beta = (1 + e) / 2 * (1 - (1 - e) / 4);
    const double packing = 0.02,
                 frequency = 2 * std::sqrt(std::numbers::pi) * 4 * packing / std::numbers::pi;
    TestScene scene = flowing_gas(1000, packing, std::sqrt(zeta / beta) * (beta + zeta) * frequency,
                                  e);
    scene.steps = 12000;
    const TensorEstimate tensor = stresses_of(scene, Method::event_driven, world);
    CHECK(-tensor.xy.value / tensor.yy.value == Approx(std::sqrt(zeta / beta)).epsilon(0.06));
}

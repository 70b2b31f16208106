// SPDX-License-Identifier: BSD-3-Clause
// Flows between thermal walls compared with Enskog's viscosity (Gass, J. Chem. Phys. 54, 1898
// (1971)), as are flows between sheared sides (tests/mpi/periodic/shear_physics_test.cpp).
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include <fmt/format.h>

#include "gas_runs.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double kt = 0.01, height = 80; // height for discs of radius 1
constexpr std::size_t n_discs = 407;     // number of discs for a packing fraction of 0.2

/// Flow along x between thermal walls that slide with -u at the bottom and u at the top.
TestScene channel(double u, double pull) {
    TestScene scene = crystal(n_discs, n_discs * std::numbers::pi / (height * height), 71);
    Random random(72);
    set_speeds(scene, std::sqrt(2 * kt), random);
    auto& sides = scene.setting.effects.boundaries;
    sides[0].kind = sides[1].kind = BoundaryKind::periodic;
    sides[2] = sides[3] = {BoundaryKind::thermal, 1, kt};
    sides[2].surface.velocity = -u;
    sides[3].surface.velocity = u;
    scene.setting.effects.gravity = {pull, 0};
    return scene;
}

/// Means of powers of y and of vx over the middle seven tenths of the channel, with y from its
/// middle.
struct Middle {
    double n = 0, y2 = 0, y4 = 0, v = 0, vy = 0, vy2 = 0, squares = 0, samples = 0;

    double density() const { return n / samples / (0.7 * height * height); }
    /// The fits vx = a + b y, and vx = a + b y^2.
    double slope() const { return vy / y2; }
    double curvature() const { return (vy2 / n - v / n * (y2 / n)) / (y4 / n - y2 / n * (y2 / n)); }
    /// unit: sqrt(kT) / diameter
    double viscosity_unit() const { return std::sqrt(squares / n) / 2; }
};

Middle sample(DiscSystem& system, std::int64_t early, std::int64_t last, std::int64_t apart,
              std::span<StepAction* const> actions = {}) {
    Middle all;
    for (std::int64_t step = early; step <= last; step += apart) {
        advance_to(system, step, actions);
        all.samples += 1;
        for (const DiscState& disc : system.shown()) {
            const double y = disc.y - height / 2;
            if (std::fabs(y) > 0.35 * height) continue;
            all.n += 1;
            all.y2 += y * y;
            all.y4 += y * y * y * y;
            all.v += disc.vx;
            all.vy += disc.vx * y;
            all.vy2 += disc.vx * y * y;
            all.squares += disc.vy * disc.vy; // kT from the velocity across the flow
        }
    }
    return all;
}

double enskog_viscosity(double density) {
    const double packing = density * std::numbers::pi, bn = 2 * packing,
                 chi = (1 - 7 * packing / 16) / ((1 - packing) * (1 - packing));
    return 1.022 / (2 * std::sqrt(std::numbers::pi)) * (1 / chi + bn + 0.8729 * chi * bn * bn);
}

} // namespace

// Gravity pulls each layer with n g, so the parabola has the curvature n g / (2 viscosity). The
// slowest mode of the channel decays in H^2 / (pi^2 nu), some 2000 steps, so 100,000 steps have 50
// decay times. With velocities of 0.1 in each of them the error of the curvature is some 3 %; four
// times that is allowed.
TEST_CASE("physics: between thermal walls gravity drives the flow of Poiseuille") {
    const Communicator world = Communicator::world();
    const double pull = 3e-5;
    DiscSystem system = event_driven_system(channel(0, pull), world);
    const Middle middle = sample(system, 10000, 110000, 200);
    const double viscosity = -middle.density() * pull / (2 * middle.curvature()) /
                             middle.viscosity_unit();
    fmt::print("Poiseuille: {:.4f}, Enskog {:.4f}\n", viscosity,
               enskog_viscosity(middle.density()));
    CHECK(viscosity == Approx(enskog_viscosity(middle.density())).epsilon(0.12));
}

// The stress is the same at each height. Within a radius of a wall it is carried by collisions with
// the wall, which the pressure tensor does not include. So the tensor is that of the rest of the
// box.
TEST_CASE("physics: between walls that slide the flow of Couette has Enskog's viscosity") {
    const Communicator world = Communicator::world();
    const TestScene scene = channel(0.07, 0);
    DiscSystem system = event_driven_system(scene, world);
    Averaging averaging(scene, system, world);
    const Middle middle = sample(system, 10000, 110000, 200, averaging.actions());
    const double stress = -averaging.averages().pressure_tensor.xy.value * height / (height - 2);
    const double viscosity = stress / middle.slope() / middle.viscosity_unit();
    fmt::print("Couette: {:.4f}, Enskog {:.4f}, slope {:.3g}\n", viscosity,
               enskog_viscosity(middle.density()), middle.slope());
    CHECK(viscosity == Approx(enskog_viscosity(middle.density())).epsilon(0.12));
}

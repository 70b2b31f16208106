// SPDX-License-Identifier: BSD-3-Clause
// Known results for gases in rectangles: the pressure does not depend on the box's shape, and
// strips are cut across the longer side.
#include <cmath>
#include <numbers>

#include "catch.hpp"

#include "averaging.hpp"
#include "initial_state/initial_state.hpp"
#include "rectangle_scenes.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr double packing = 0.3;
/// Z at that packing fraction: the virial series to B10, whose last terms are below 1e-4.
constexpr double known_z = 2.06316;

SceneParameters periodic_gas(const Box& shape, std::uint64_t n) {
    SceneParameters scene;
    scene.name = "gas";
    const double scale = std::sqrt(static_cast<double>(n) * std::numbers::pi / packing);
    scene.box = {scale * shape.x, scale * shape.y};
    scene.radius = 1;
    scene.n_discs = n;
    scene.speed = 0.3;
    scene.steps = 3000;
    scene.effects.boundaries = all_round;
    return scene;
}

Averages averages_of(const SceneParameters& scene, const Communicator& world) {
    DiscSystem system(scene, initial_state(scene, nullptr, world), world, {});
    advance_to(system, 200);
    Averaging averaging(scene, system, world);
    averaging.advance_to(scene.steps);
    return averaging.averages();
}

/// The extent of the own discs; of all discs if there is one rank.
Box room_of(const DiscSystem& system, const Communicator& world) {
    double high[] = {-1e300, -1e300}, low[] = {-1e300, -1e300};
    for (const DiscState& disc : system.discs()) {
        const double place[] = {disc.x_at(system.clock()), disc.y_at(system.clock())};
        for (int k = 0; k < 2; ++k) {
            high[k] = std::max(high[k], place[k]);
            low[k] = std::max(low[k], -place[k]);
        }
    }
    return {world.max(high[0] + low[0]), world.max(high[1] + low[1])};
}

} // namespace

TEST_CASE("rectangles: a periodic box of 10 to 1 has the square's pressure") {
    const Communicator world = Communicator::world();
    const std::uint64_t n = 1000;
    const Averages square = averages_of(periodic_gas({1, 1}, n), world),
                   wide = averages_of(periodic_gas({std::sqrt(10.0), 1 / std::sqrt(10.0)}, n),
                                      world);
    const auto difference = [](const Estimate& a, const Estimate& b) {
        return std::fabs(a.value - b.value) / std::hypot(a.error, b.error);
    };
    INFO(square.compressibility.value << " and " << wide.compressibility.value << " +- "
                                      << wide.compressibility.error);
    CHECK(wide.compressibility.error < 0.01);
    CHECK(difference(square.compressibility, wide.compressibility) < 4);
    CHECK(difference(wide.pressure_tensor.xx, wide.pressure_tensor.yy) < 4);
    // For N discs of zero total momentum Z differs from the bulk's by at most (Z - 1) / N.
    CHECK(std::fabs(wide.compressibility.value - known_z) <
          4 * wide.compressibility.error + 3 * (known_z - 1) / static_cast<double>(n));
}

TEST_CASE("rectangles: strips cut the longer side") {
    const Communicator world = Communicator::world();
    for (const bool stands : {false, true}) {
        SceneParameters scene = periodic_gas({std::sqrt(10.0), 1 / std::sqrt(10.0)}, 600);
        if (stands) std::swap(scene.box.x, scene.box.y);
        DiscSystem system(scene, initial_state(scene, nullptr, world), world, {});
        const Box room = room_of(system, world);
        const double longer = std::max(room.x, room.y), shorter = std::min(room.x, room.y);
        CHECK((room.x < room.y) == (stands && world.size() < 10));
        CHECK(longer < 1.05 * scene.box.longest() / world.size());
        CHECK(shorter > 0.8 * scene.box.shortest());
    }
}

TEST_CASE("rectangles: generated gases in a box that stands are those in one that lies") {
    const Communicator world = Communicator::world();
    for (const Generator generator : {Generator::random, Generator::lattice}) {
        SceneParameters lying = periodic_gas({1.5, 0.5}, 300), standing = lying;
        lying.generator = standing.generator = generator;
        std::swap(standing.box.x, standing.box.y);
        std::vector<InputDisc> a = initial_state(lying, nullptr, world),
                               b = initial_state(standing, nullptr, world);
        const auto by_id = [](const InputDisc& p, const InputDisc& q) { return p.id < q.id; };
        std::sort(a.begin(), a.end(), by_id);
        std::sort(b.begin(), b.end(), by_id);
        for (InputDisc& disc : b) {
            std::swap(disc.x, disc.y);
            std::swap(disc.vx, disc.vy);
        }
        CHECK(a == b);
    }
}

// SPDX-License-Identifier: BSD-3-Clause
// Growing discs: results computed by hand, and the bits of the reference.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "catch.hpp"

#include "reference_bits.hpp"
#include "scene_tools.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

constexpr Boundary periodic_side{BoundaryKind::periodic, 1, 0, 0};

/// The disc on the rank that has it; NaN on all others.
DiscState disc_of(const DiscSystem& system, DiscId id, const Communicator& world) {
    double numbers[] = {0, 0, 0, 0};
    std::uint64_t owner = 0;
    for (const DiscState& disc : system.shown()) {
        if (disc.id != id) continue;
        owner = static_cast<std::uint64_t>(world.rank()) + 1;
        numbers[0] = disc.x_at(system.clock());
        numbers[1] = disc.y_at(system.clock());
        numbers[2] = disc.vx * system.velocity_unit();
        numbers[3] = disc.vy * system.velocity_unit();
    }
    owner = world.max(owner);
    REQUIRE(owner > 0);
    for (double& number : numbers) world.broadcast(number, static_cast<int>(owner) - 1);
    return {numbers[0], numbers[1], numbers[2], numbers[3], 0, id};
}

} // namespace

TEST_CASE("growth: two discs at rest meet when they have grown, and part faster than they grow") {
    const Communicator world = Communicator::world();
    TestScene scene = empty_scene("two growing discs", 40, 1, 12);
    scene.setting.effects.growth = 0.125; // diameters 2 + t / 4: contact at step 8
    scene.setting.micro_steps = 4;
    scene.setting.sync_every = 7;
    add_disc(scene, 18, 20);
    add_disc(scene, 22, 20);
    DiscSystem system = system_of(scene, Method::event_driven, world);
    advance_to(system, 12);
    const DiscState p = disc_of(system, 0, world), q = disc_of(system, 1, world);
    // The surfaces met with -1/4, so each disc leaves at 1/4.
    CHECK(p.x == Approx(18 - 4 * 0.25).epsilon(1e-14));
    CHECK(q.x == Approx(22 + 4 * 0.25).epsilon(1e-14));
    CHECK(p.vx == Approx(-0.25).epsilon(1e-14));
    CHECK(q.vx == Approx(0.25).epsilon(1e-14));
    CHECK(p.vy == 0);
    CHECK(system.totals().pair_collisions == 1);
    CHECK(system.totals().kinetic_energy == Approx(0.0625).epsilon(1e-13));
}

TEST_CASE("growth: discs of two masses that fly towards each other, and a disc at a wall") {
    const Communicator world = Communicator::world();
    TestScene scene = empty_scene("growing discs of two masses", 64, 2, 6);
    scene.setting.effects.growth = 0.25;
    scene.setting.effects.species = {{1, 2, 3}, {2, 1, 1}};
    scene.setting.sync_every = 5;
    add_disc(scene, 20, 20, 0.5, 0.125); // distance 12, diameters 3 + 3t/4
    add_disc(scene, 32, 20, -1, 0.125);  // 12 - 3t/2 = 3 + 3t/4: contact at step 4
    add_disc(scene, 50, 62, 0.25, 0);    // 2 from the top, r = 1 + t/4: contact at step 4
    DiscSystem system = system_of(scene, Method::event_driven, world);
    advance_to(system, 6);
    const DiscState p = disc_of(system, 0, world), q = disc_of(system, 1, world),
                    at_wall = disc_of(system, 2, world);
    // Surfaces meet with -3/2 - 3/4 and part with the opposite: w = 3/4 + 9/4 = 3, and the momentum
    // is 1/2.
    CHECK(p.vx == Approx(-0.625).epsilon(1e-14));
    CHECK(q.vx == Approx(2.375).epsilon(1e-14));
    CHECK(p.vy == Approx(0.125).epsilon(1e-14));
    CHECK(p.x == Approx(22 - 2 * 0.625).epsilon(1e-14));
    CHECK(at_wall.y == Approx(62 - 2 * 0.5).epsilon(1e-14));
    CHECK(at_wall.vy == Approx(-0.5).epsilon(1e-14));
    CHECK(at_wall.vx == 0.25);
}

TEST_CASE("growth: discs have the reference's bits, with restitution, species and periodic sides") {
    const Boundary lossy{BoundaryKind::wall, 0.7, 0, 0};
    for (TestScene scene : base_scenes()) {
        Effects& effects = scene.setting.effects;
        effects.growth = 0.008;
        check_bits(scene, Method::event_driven);
        effects.boundaries = {periodic_side, periodic_side, lossy, Boundary{}};
        effects.contact = {ContactKind::restitution, 0.9, 0.002};
        if (scene.name.find("cradle") == std::string::npos) check_bits(scene, Method::event_driven);
        effects.boundaries.fill(periodic_side);
        effects.contact = {};
        const std::uint64_t n = scene.discs.size();
        effects.species = {{n / 2, scene.setting.radius, 2},
                           {n - n / 2, 0.7 * scene.setting.radius, 0.6}};
        if (scene.name.find("cradle") == std::string::npos) check_bits(scene, Method::event_driven);
    }
}

TEST_CASE("growth: transposed scenes give transposed discs") {
    const Communicator world = Communicator::world();
    TestScene scene = gas(196, 0.5, 0.3, 512);
    scene.steps = 20;
    scene.setting.effects.growth = 0.01;
    const TestScene other = transposed(scene);
    DiscSystem first = system_of(scene, Method::event_driven, world),
               second = system_of(other, Method::event_driven, world);
    advance_to(first, 20);
    advance_to(second, 20);
    int differences = 0;
    for (DiscId id = 0; id < scene.discs.size(); ++id) {
        const DiscState a = disc_of(first, id, world), b = disc_of(second, id, world);
        differences += a.x != b.y || a.y != b.x || a.vx != b.vy || a.vy != b.vx;
    }
    CHECK(differences == 0);
    CHECK(first.totals().pair_collisions > 100);
}

TEST_CASE("growth: discs that have no more room end the run with a sentence") {
    const Communicator world = Communicator::world();
    TestScene scene = lattice(4, 1.2); // a square lattice jams long before its packing is 0.9
    scene.steps = 1;
    scene.setting.effects.growth = 0.25;
    std::string text;
    try {
        run(scene, Method::event_driven, world);
    } catch (const CollectiveError& error) {
        text = error.what();
    }
    INFO(text);
    // They touch when radii are 1.2 times the first; the message names an earlier step.
    CHECK(text.find("discs jam after step 0.79") != std::string::npos);
    CHECK(text.find("(radii 1.19") != std::string::npos);
}

namespace {

/// Whether the scene's discs jam at that rate of growth.
bool do_jam(TestScene scene, double growth, const Communicator& ranks,
            const std::optional<double>& window) {
    scene.setting.effects.growth = growth;
    Tuning tuning;
    tuning.window = window;
    try {
        run(scene, Method::event_driven, ranks, tuning);
    } catch (const CollectiveError& error) {
        INFO(growth << ": " << error.what());
        const std::string text = error.what();
        const bool is_named = text.find("discs jam") != std::string::npos ||
                              text.find("collides without end") != std::string::npos;
        CHECK(is_named);
        return true;
    }
    return false;
}

} // namespace

TEST_CASE("growth: windows, ranks and threads agree on whether discs jam") {
    const Communicator world = Communicator::world(), alone = Communicator::of_this_rank();
    TestScene scene = gas(12, 0.5, 2, 7);
    scene.steps = 8;
    scene.setting.sync_every = 8 * scene.setting.micro_steps;
    double none = 0.01, jam = 0.08; // rates of growth
    for (int k = 0; k < 10; ++k) {
        const double between = (none + jam) / 2;
        (do_jam(scene, between, alone, std::nullopt) ? jam : none) = between;
    }
    INFO("they do between growths of " << none << " and " << jam);
    for (const auto& window : {std::optional<double>(), std::optional(0.3), std::optional(0.01)}) {
        CHECK(!do_jam(scene, none, world, window));
        CHECK(do_jam(scene, jam, world, window));
    }
}

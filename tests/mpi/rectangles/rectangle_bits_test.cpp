// SPDX-License-Identifier: BSD-3-Clause
// Wide and tall rectangles have the bits of the references of both methods. The same scene
// reflected at its diagonal has the same bits with x and y exchanged.
#include <algorithm>
#include <vector>

#include "catch.hpp"

#include "parallel/exchange.hpp"
#include "rectangle_scenes.hpp"
#include "reference_bits.hpp"

using namespace carrom;
using namespace carrom::test;

namespace {

struct State {
    DiscState disc;
    double spin = 0;
};

/// The states of all discs by id, on every rank. **Collective.**
std::vector<State> states_of(const TestScene& scene, Method method, const Communicator& world) {
    DiscSystem system = system_of(scene, method, world);
    advance_to(system, scene.steps);
    std::vector<State> mine, all;
    for (const DiscState& disc : system.discs()) mine.push_back({disc, 0});
    const std::span<const double> spins = system.spins();
    for (std::size_t i = 0; i < spins.size(); ++i) mine[i].spin = spins[i];
    stream_to_root(
        world, std::span<const State>(mine),
        [&](std::span<const State> some) { all.insert(all.end(), some.begin(), some.end()); },
        1000);
    world.broadcast(all);
    std::sort(all.begin(), all.end(),
              [](const State& a, const State& b) { return a.disc.id < b.disc.id; });
    return all;
}

/// A reflection at the diagonal reverses spins.
bool are_turned(const State& a, const State& b) {
    const DiscState &p = a.disc, &q = b.disc;
    return p.x == q.y && p.y == q.x && p.vx == q.vy && p.vy == q.vx && p.tau == q.tau &&
           p.pair_collisions == q.pair_collisions && p.wall_collisions == q.wall_collisions &&
           p.is_departed == q.is_departed && a.spin == -b.spin;
}

} // namespace

TEST_CASE("rectangles: both methods have the references' bits") {
    for (const Case& one : cases()) check_bits(one.scene, one.method);
}

TEST_CASE("rectangles: standing ones have the references' bits") {
    for (const Case& one : cases()) check_bits(transposed(one.scene), one.method);
}

TEST_CASE("rectangles: transposed scenes have transposed bits") {
    const Communicator world = Communicator::world();
    for (const Case& one : cases()) {
        INFO(one.scene.name << (one.method == Method::time_stepped ? ", time-stepped" : ""));
        const std::vector<State> lying = states_of(one.scene, one.method, world),
                                 standing = states_of(transposed(one.scene), one.method, world);
        CHECK(std::equal(lying.begin(), lying.end(), standing.begin(), standing.end(), are_turned));
        CHECK(std::any_of(lying.begin(), lying.end(),
                          [](const State& state) { return state.disc.pair_collisions > 0; }));
    }
}

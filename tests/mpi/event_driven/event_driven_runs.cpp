// SPDX-License-Identifier: BSD-3-Clause
#include "event_driven_runs.hpp"
#include "core/state_hash.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <random>
#include <stdexcept>

#include <omp.h>

#include "event_driven.hpp"
#include "shape_parts.hpp"

namespace carrom::test {

namespace {

/// Successive scenes differ in one respect, so neighbours go to different parts, and so does every
/// n-th scene. If too many threads would run, every second scene belongs to no part.
bool belongs_to_part(std::size_t number, int n_threads) {
    const std::optional<ShapePart> part = shape_part();
    if (!part) return true;
    const std::size_t round = number / part->count, home = (number + round) % part->count;
    return home == part->number && (round % 2 == 0 || n_threads <= 4);
}

} // namespace

bool is_wanted(const TestScene& scene, std::size_t number) {
    const char* const name = std::getenv("CARROM_TEST_SCENE");
    if (name != nullptr) return scene.name.find(name) != std::string::npos;
    return belongs_to_part(number, Communicator::world().size() * omp_get_max_threads());
}

EventDrivenResult expected_of(TestScene& scene, const Communicator& world,
                              std::size_t most_predictions) {
    EventDrivenResult expected;
    std::int64_t steps = 0;
    if (world.is_root()) {
        const std::size_t most_events = 200 + most_predictions / scene.discs.size();
        reference::EventDrivenReference reference(scene.setting, scene.discs, 20 * most_events);
        try {
            for (; steps < scene.steps && reference.log().size() < most_events; ++steps) {
                expected = {hash_of(reference.discs()), reference.wall_collisions(),
                            reference.pair_collisions()};
                reference.run_steps(1);
            }
            expected = {hash_of(reference.discs()), reference.wall_collisions(),
                        reference.pair_collisions()};
        } catch (const std::runtime_error&) {
            // The reference gave up a step; `expected` has the state before it.
        }
    }
    world.broadcast(expected);
    world.broadcast(steps);
    scene.steps = steps;
    return expected;
}

DiscStates dealt_discs(const TestScene& scene, const Communicator& world, unsigned seed) {
    std::mt19937 random(seed);
    DiscStates mine;
    for (const DiscState& disc : reference::stored_states(scene.setting, scene.discs)) {
        if (static_cast<int>(random() % static_cast<unsigned>(world.size())) == world.rank())
            mine.push_back(disc);
    }
    std::shuffle(mine.begin(), mine.end(), random);
    return mine;
}

double diameter_time(const TestScene& scene) {
    double fastest = 0;
    for (const InputDisc& disc : scene.discs)
        fastest = std::max(fastest, std::sqrt(disc.vx * disc.vx + disc.vy * disc.vy));
    if (fastest == 0) return 1;
    const auto micro_steps = static_cast<double>(scene.setting.micro_steps);
    return std::max(2 * scene.setting.radius * micro_steps / fastest,
                    static_cast<double>(scene.steps) * micro_steps / 60);
}

Shape shape_number(std::size_t number, double diameter_time) {
    const std::optional<double> windows[] = {std::nullopt, 0.1, 0.7, 3.3};
    const std::optional<double> boundaries[] = {std::nullopt, 1.0, 2.5, 6.0, 100.0};
    const double rebalances[] = {1.05, 0.0, 1e9};
    Shape shape;
    shape.tuning.threads = omp_get_max_threads();
    shape.tuning.discs_per_thread = 1;
    if (const auto& window = windows[number % std::size(windows)])
        shape.tuning.window = *window * diameter_time;
    shape.exact.block_side = boundaries[number % std::size(boundaries)];
    if (number % 10 == 0) shape.exact.cuts_by_work = true;
    shape.exact.halo = 2 + static_cast<int>(number / 2 % 3);
    shape.exact.speed_allowance = number % 7 == 3 ? 1.001 : 1.2;
    shape.tuning.rebalance_above = rebalances[number / 3 % std::size(rebalances)];
    shape.tuning.ranks_across = 1 + static_cast<int>(number % 3);
    return shape;
}

Shape small_blocks(double window, int halo, double side) {
    Shape shape;
    shape.tuning.threads = omp_get_max_threads();
    shape.tuning.discs_per_thread = 1;
    shape.tuning.window = window;
    shape.exact.halo = halo;
    shape.exact.block_side = side;
    return shape;
}

EventDrivenResult run_event_driven(const TestScene& scene, const Shape& shape,
                                   const Communicator& world, unsigned seed) {
    EventDrivenEngine<PlainDynamics> engine(scene_of(scene), {dealt_discs(scene, world, seed), 0},
                                            world, shape.tuning, shape.exact);
    const std::int64_t last = scene.steps * scene.setting.micro_steps;
    while (engine.micro_steps_done() < last) engine.advance_towards(scene.steps);
    StateHash hash = hash_of(engine.own());
    std::uint64_t sums[] = {hash.low, hash.high, 0, 0};
    for (const DiscState& disc : engine.own()) {
        sums[2] += disc.wall_collisions;
        sums[3] += disc.pair_collisions;
    }
    world.sum(sums);
    return {{sums[0], sums[1]}, sums[2], sums[3] / 2};
}

} // namespace carrom::test

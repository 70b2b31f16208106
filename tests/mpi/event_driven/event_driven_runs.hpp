// SPDX-License-Identifier: BSD-3-Clause
// Runs of the event-driven method on all ranks, and what they must give.
#pragma once

#include "event_driven/event_driven_engine.hpp"
#include "parallel/communicator.hpp"
#include "scenes.hpp"
#include "simulation/disc_system.hpp"

namespace carrom::test {

struct EventDrivenResult {
    StateHash hash;
    std::uint64_t wall_collisions = 0, pair_collisions = 0;

    friend bool operator==(const EventDrivenResult&, const EventDrivenResult&) = default;
};

/// Whether the scene, `number` in its list, is to be run: it belongs to the shape's part
/// (shape_parts.hpp), and $CARROM_TEST_SCENE, if set, is a part
/// of its name (to inspect one scene).
bool is_wanted(const TestScene& scene, std::size_t number);

/// What the event-driven reference gives, worked out on rank 0. Cuts the scene's steps short where
/// the reference would take long: its price is the number of discs per event. **Collective.**
EventDrivenResult expected_of(TestScene& scene, const Communicator& world,
                              std::size_t most_predictions);

struct Shape {
    Tuning tuning;
    BlockTuning exact;
};

/// A way to run a scene: windows, blocks, halo, cuts. The numbers meet one another in many
/// combinations.
Shape shape_number(std::size_t number, double diameter_time);

/// Windows of `window` micro-steps, and blocks of `side` reaches that look `halo` reaches further.
Shape small_blocks(double window, int halo, double side);

/// A run from arbitrary shares of the discs, in an arbitrary order. **Collective.**
EventDrivenResult run_event_driven(const TestScene& scene, const Shape& shape,
                                   const Communicator& world, unsigned seed);

/// The share of rank `world.rank()` when discs are dealt at random.
DiscStates dealt_discs(const TestScene& scene, const Communicator& world, unsigned seed);

/// The time in which the fastest disc goes one diameter, in micro-steps; a 60th of the run if that
/// is longer.
double diameter_time(const TestScene& scene);

} // namespace carrom::test

// SPDX-License-Identifier: BSD-3-Clause
// Runs of the event-driven method on all ranks, and their expected results.
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

/// Whether to run the scene with this number in its list. It must belong to the part of this
/// machine shape (shape_parts.hpp). If $CARROM_TEST_SCENE is set, the scene's name must contain it,
/// which serves to inspect one scene.
bool is_wanted(const TestScene& scene, std::size_t number);

/// The result of the event-driven reference, computed on rank 0. Reduces the scene's steps if the
/// reference would take long, because it computes N predicates per event. **Collective.**
EventDrivenResult expected_of(TestScene& scene, const Communicator& world,
                              std::size_t most_predictions);

struct Shape {
    Tuning tuning;
    BlockTuning exact;
};

/// A setting for a run: windows, blocks, halo, cuts. Successive numbers give many combinations.
Shape shape_number(std::size_t number, double diameter_time);

/// Windows of `window` micro-steps, and blocks of `side` reaches with a halo of `halo` reaches.
Shape small_blocks(double window, int halo, double side);

/// A run in which each rank starts with random discs in a random order. **Collective.**
EventDrivenResult run_event_driven(const TestScene& scene, const Shape& shape,
                                   const Communicator& world, unsigned seed);

/// The share of rank `world.rank()` when discs are distributed at random.
DiscStates dealt_discs(const TestScene& scene, const Communicator& world, unsigned seed);

/// The time in micro-steps in which the fastest disc flies one diameter; at least a 60th of the
/// run.
double diameter_time(const TestScene& scene);

} // namespace carrom::test

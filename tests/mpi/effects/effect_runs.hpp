// SPDX-License-Identifier: BSD-3-Clause
// Runs of scenes with effects on all ranks.
#pragma once

#include "scene_tools.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

namespace carrom::test {

/// The scene's discs are dealt to the ranks at random. **Collective.**
DiscSystem system_of(const TestScene& scene, Method method, const Communicator& world,
                     const Tuning& tuning = {});

/// To the scene's last step. **Collective.**
Totals run(const TestScene& scene, Method method, const Communicator& world,
           const Tuning& tuning = {});

/// As `run`, but it stops after each step, and half way another simulation goes on from the state.
/// **Collective.**
Totals run_with_restart(const TestScene& scene, Method method, const Communicator& world);

/// Checks that a run of the scene on all ranks keeps the invariants of each step, and ends with the
/// state of a run on one rank.
void check_shared_run(const TestScene& scene, Method method, const Communicator& world);

/// Discs that are where obstacles are leave the scene; the others are numbered anew.
void make_room_for_obstacles(TestScene& scene);

/// Drag of that rate per step, and what the references are told of it.
void set_drag(TestScene& scene, double rate);

} // namespace carrom::test

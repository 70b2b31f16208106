// SPDX-License-Identifier: BSD-3-Clause
// Runs of scenes with effects on all ranks.
#pragma once

#include "scene_tools.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

namespace carrom::test {

/// Distributes the scene's discs over the ranks at random. **Collective.**
DiscSystem system_of(const TestScene& scene, Method method, const Communicator& world,
                     const Tuning& tuning = {});

/// Runs to the scene's last step. **Collective.**
Totals run(const TestScene& scene, Method method, const Communicator& world,
           const Tuning& tuning = {});

/// Like `run`, but stops after each step, and continues half way with another simulation of the
/// stored state. **Collective.**
Totals run_with_restart(const TestScene& scene, Method method, const Communicator& world);

/// Checks that a run of the scene on all ranks keeps the invariants of each step, and ends with the
/// state of a run on one rank.
void check_shared_run(const TestScene& scene, Method method, const Communicator& world);

/// Removes discs that overlap obstacles, and numbers the others again.
void make_room_for_obstacles(TestScene& scene);

/// Sets drag with this rate per step, in the scene and for the references.
void set_drag(TestScene& scene, double rate);

} // namespace carrom::test

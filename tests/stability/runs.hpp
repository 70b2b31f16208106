// SPDX-License-Identifier: BSD-3-Clause
// Runs of both methods, and the worst values that tests compare with their bounds.
#pragma once

#include <string>
#include <vector>

#include "core/disc_state.hpp"
#include "parallel/communicator.hpp"
#include "scenes.hpp"
#include "simulation/disc_system.hpp"

namespace carrom::test {

/// All discs of all ranks in the order of their ids; velocities per micro-step, times on `clock`.
struct Outcome {
    std::vector<DiscState> discs;
    double clock = 0;
    Totals totals;
};

/// "time-stepped" or "event-driven".
std::string name_of(Method method);

/// The scene's start, distributed over the ranks at random and in random order, with as many
/// threads as OpenMP has. **Collective.**
DiscSystem start(const TestScene& scene, Method method, Tuning tuning = {}, unsigned seed = 1);

/// Continues to `step`. **Collective.**
void run_to(DiscSystem& system, std::int64_t step);

/// **Collective.**
Outcome outcome_of(const DiscSystem& system);

/// Runs the whole scene. **Collective.**
Outcome run(const TestScene& scene, Method method, const Tuning& tuning = {}, unsigned seed = 1);

/// The message of a run that is rejected or ends early; empty if it does not fail. **Collective.**
std::string failure_of(const TestScene& scene, Method method);

/// Every collision of the scene in the total order, on every rank. **Collective.**
std::vector<Collision> collisions_of(const TestScene& scene, Method method);

/// One ulp of the box: the distance of doubles just below `box_size`.
double ulp_of(double size);

/// Depth of the deepest overlap of two discs at `outcome.clock`, or of two discs at the time of
/// their last collision if that was with each other; negative if none touch.
double deepest_overlap(const Outcome& outcome, double sigma);

/// The largest distance of a centre outside of [r, L-r]; negative if all are inside.
double farthest_outside(const Outcome& outcome, const reference::Setting& setting);

/// The sum of squared speeds, computed in quadruple precision and rounded once.
double squared_speeds(const Outcome& outcome);

} // namespace carrom::test

// SPDX-License-Identifier: BSD-3-Clause
// What a run's self-check throws (Simulation::check_every_step): which invariant is broken, where,
// and the discs around.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scene/scene.hpp"

namespace carrom {

/// In the order in which they are looked for. The first one found is reported.
enum class Invariant : int {
    finite,     ///< every number of every state is finite
    owned_once, ///< each of the discs 0 .. N-1 is some rank's own, and of one rank only
    in_box,     ///< its centre is a radius from every wall, to within rounding
    in_strip,   ///< its owner's strip holds it
    in_cell,    ///< and the cell that it is filed under
    clear,      ///< it is in no obstacle
    counters, ///< its counters have grown by the collisions that were carried out with it, for both
              ///< discs of a pair
    motion,   ///< its velocity and its spin have changed by collisions only
    overlap,  ///< no pair overlaps, unless the time-stepped method explains it
    energy, ///< discs that have collided have the energy together that they had before; so have all
};

/// Thrown on every rank with the same contents; exit code 70. `discs_around`: the reported discs,
/// those that they collided with and the nearest, as they were when the failed step began, in the
/// order of their ids. It is empty where the reported disc does not exist. Rough discs' spins, per
/// step, run along them.
class CheckFailure : public CollectiveError {
public:
    CheckFailure(const std::string& text, Invariant broken, std::int64_t at_step, DiscId reported,
                 int on_rank, std::vector<InputDisc> around, std::vector<double> their_spins = {})
        : CollectiveError(text, ExitCode::broken_invariant), invariant(broken), step(at_step),
          disc(reported), rank(on_rank), discs_around(std::move(around)),
          spins(std::move(their_spins)) {}

    Invariant invariant;
    std::int64_t step; ///< at whose end it was found
    DiscId disc;
    int rank; ///< that owns the disc, or did
    std::vector<InputDisc> discs_around;
    std::vector<double> spins;
};

} // namespace carrom

// SPDX-License-Identifier: BSD-3-Clause
// The error of a run's self-check (DiscSystem::check_every_step): which invariant is
// broken, where, and the discs around.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scene/scene_parameters.hpp"

namespace carrom {

/// Invariants of each disc, in the order of the checks. The first broken one is reported.
enum class Invariant : int {
    finite,     ///< every number of every state is finite
    owned_once, ///< each of the discs 0 .. N-1 is owned by exactly one rank
    radius,     ///< the radius that swaps have given a disc is the one that it collides with
    in_box,     ///< the disc's centre is at least a radius away from every wall, within rounding
    departed,   ///< a disc leaves by an open side, stays outside, and comes back by an inlet only
    in_domain,  ///< the disc is in the domain of the rank that owns it
    in_cell,    ///< the disc is in the cell into which it was sorted
    clear,      ///< the disc does not overlap a fixed body
    /// The disc's counters have grown by the number of its collisions; a collision of a pair counts
    /// for both discs
    counters,
    motion,  ///< the disc's velocity and its spin have changed in collisions only
    overlap, ///< no pair overlaps, except as the time-stepped method allows
    energy,  ///< the discs that have collided have the same total energy as before, and so
             ///< have all discs
};

/// Thrown on every rank with the same contents; exit code 70. `discs_around`: the reported discs,
/// the discs with which they collided and the nearest ones, at the start of the failed step, in the
/// order of their ids. It is empty if the reported disc does not exist. Spins of rough discs, per
/// step, run along them, and so do the present radii of discs that exchange them.
class CheckFailure : public CollectiveError {
public:
    CheckFailure(const std::string& text, Invariant broken, std::int64_t at_step, DiscId reported,
                 int on_rank, std::vector<InputDisc> around, std::vector<double> their_spins = {},
                 std::vector<double> their_radii = {})
        : CollectiveError(text, ExitCode::broken_invariant), invariant(broken), step(at_step),
          disc(reported), rank(on_rank), discs_around(std::move(around)),
          spins(std::move(their_spins)), radii(std::move(their_radii)) {}

    Invariant invariant;
    std::int64_t step; ///< the step that ended with the broken invariant
    DiscId disc;
    int rank; ///< the rank that owned the disc last
    std::vector<InputDisc> discs_around;
    std::vector<double> spins, radii;
};

} // namespace carrom

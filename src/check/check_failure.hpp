// SPDX-License-Identifier: BSD-3-Clause
// The error of a run's self-check (DiscSystem::check_every_step): the broken invariant, the disc
// and step, and the discs around it.
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
    radius,     ///< the disc collides with the radius that swaps have given it
    in_box,     ///< the disc's centre is at least a radius away from every wall, within rounding
    departed,   ///< a disc leaves only by an open side, stays outside, and returns only by an inlet
    in_domain,  ///< the disc is in the domain of the rank that owns it
    in_cell,    ///< the disc is in the cell into which it was sorted
    clear,      ///< the disc does not overlap a body fixed in the box
    /// The disc's counters have grown by the number of its collisions; a collision of two discs
    /// counts for both
    counters,
    motion,  ///< the disc's velocity and spin have changed only in collisions
    overlap, ///< no pair overlaps, unless the time-stepped method allows it
    energy,  ///< only effects change the total energy of discs that collisions link, and
             ///< that of all discs
};

/// Thrown on every rank with the same contents; exit code 70. `discs_around`, sorted by id,
/// contains the reported discs, their partners in collisions and the nearest discs, at the start of
/// the failed step. It is empty if the reported disc does not exist. `spins` (of rough discs, per
/// step) and `radii` (of discs that exchange radii) are in the order of `discs_around`.
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
    int rank; ///< the last rank that owned the disc
    std::vector<InputDisc> discs_around;
    std::vector<double> spins, radii;
};

} // namespace carrom
